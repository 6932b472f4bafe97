// The catalogue of effects a scene may call for: what each is named, which parameters it takes, how it joins
// a plan.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <hompm/scene/scene.hpp>

namespace hompm {

struct PairBuilder;
struct PlanBuilder;
struct State;
struct EffectType;
using EffectCatalogue = std::vector<EffectType>;

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

/// What effects do to small motions.
struct SmallMotion {
  double viscous_time = 0.0;  ///< τ, s, of the stress E τ ∂v/∂x
  double damping_rate = 0.0;  ///< β, 1/s, of the body force −β v
  double force_factor = 1.0;  ///< by which the force out of balance may grow
};

/// What an effect may do as a load.
struct LoadOutlook {
  double settled_from = 0.0;  ///< s, from when on it no longer changes; infinite where it always does
  double energy = 0.0;        ///< J/m², about as much as it may give to the body in the time of the run
};

enum class Side { left, right };

/// The critical time step is first that of ends which move as if nothing held them, and must then leave the
/// motion bounded where they are held (docs/stability.md).
enum class LinearEnd { let_go, held };

/// One row of the catalogue.
struct EffectType {
  std::string name;
  std::string meaning;
  std::vector<EffectParameter> parameters;
  /// Adds the stages of the effect to a plan.
  void (*join)(const EffectSpec& spec, const PlanBuilder& builder);
  /// Why the effect does not go with the rest of the scene; "" where it does.
  std::string (*conflict)(const EffectSpec& spec, const Scene& scene) = nullptr;
  /// What the effect does to small motions, and so to the critical step; null: nothing.
  SmallMotion (*small_motion)(const EffectSpec& spec, const Scene& scene) = nullptr;
  /// What a load may do; null for what is none.
  LoadOutlook (*outlook)(const EffectSpec& spec, const Scene& scene) = nullptr;
  /// Changes the state at t = 0, before the plan is made: the velocity, say.
  void (*prepare)(const EffectSpec& spec, const Scene& scene, State& state) = nullptr;
  /// Decides how an end moves (its parameter `end`, which must be free): one such effect at each end, joined
  /// after all others.
  bool holds_end = false;
  /// What such an effect does to one end in the linear step of the critical time step.
  void (*join_linear)(Side side, LinearEnd how, const PlanBuilder& builder) = nullptr;
  /// Adds to the total stress: `StageBuilder::add_total_stress` has been called before it joins.
  bool adds_stress = false;
  /// In place of `join`: couples the right end of a body to the left end of the next; both are held, and
  /// free.
  void (*join_pair)(const EffectSpec& spec, const PairBuilder& pair) = nullptr;

  [[nodiscard]] bool couples() const { return join_pair != nullptr; }
  /// Whether an effect of this type acts on the left or right end of a body as what holds it, in a scene of
  /// `count` bodies.
  [[nodiscard]] bool holds(const EffectSpec& spec, const std::string& end, std::int64_t body,
                           std::int64_t count) const;
};

/// The effects of the library, in the order in which `--list` shows them (catalogue.cmake).
const EffectCatalogue& effect_catalogue();

/// What the names of effects mean in this scene: `Scene::effect_types`, or the library's own.
const EffectCatalogue& effects_of(const Scene& scene);

/// The row that an effect of the scene means. Throws `SceneError` where there is none.
const EffectType& find_effect(const Scene& scene, const EffectSpec& spec);

/// `EffectType::prepare` of all effects of the scene.
void prepare_effects(const Scene& scene, State& state);

/// What the loads of the scene may do together.
LoadOutlook outlook(const Scene& scene);

/// `EffectType::join_linear` at all free ends of a body, once each.
void join_linear_ends(const Scene& scene, LinearEnd how, const PlanBuilder& builder);

/// What the `small_motion` of all effects of the scene comes to.
SmallMotion small_motion(const Scene& scene);

}  // namespace hompm
