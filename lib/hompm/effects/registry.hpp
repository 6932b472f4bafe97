// The catalogue of effects a scene may call for: what each is named, which parameters it takes, how it joins
// a plan.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <hompm/scene/scene.hpp>

namespace hompm {

struct PlanBuilder;

/// One parameter of an effect, as a scene may give it.
struct EffectParameter {
  std::string name;
  std::string unit;  ///< SI, "–" for none; empty for a word
  std::string meaning;
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool minimum_excluded = false;
  std::vector<std::string> words = {};                  ///< the words allowed; empty for a number
  std::optional<EffectSpec::Value> default_value = {};  ///< none: the parameter must be given
};

/// One row of the catalogue.
struct EffectType {
  std::string name;
  std::string meaning;
  std::vector<EffectParameter> parameters;
  /// Adds the stages of the effect to a plan.
  void (*join)(const EffectSpec& spec, PlanBuilder& plan);
};

/// All effects, in the order in which `--list` shows them.
const std::vector<EffectType>& effect_catalogue();

}  // namespace hompm
