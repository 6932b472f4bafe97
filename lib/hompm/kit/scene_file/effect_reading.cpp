#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <hompm/kit/scene_file/reading.hpp>

namespace hompm::detail {
namespace {

ValueRule type_rule(const Scene& scene) {
  ValueRule rule{.type = ValueType::word};
  for (const EffectType& type : effects_of(scene)) rule.words.push_back(type.name);
  return rule;
}

EffectSpec::Value parameter_value(const Content& content) {
  if (const auto* number = std::get_if<double>(&content)) return *number;
  return std::get<std::string>(content);
}

// Reports what the effect does not know; returns the parameters that were meant.
std::set<std::string> check_parameter_names(Reading& reading, const EffectType& type,
                                            const std::string& path) {
  std::vector<std::string> names{"type"};
  if (reading.bodies > 1) names.emplace_back("body");
  for (const EffectParameter& parameter : type.parameters) names.push_back(parameter.name);
  return check_names_in(reading, path, names, "the effect " + type.name);
}

void read_parameters(Reading& reading, const EffectType& type, const std::string& path, EffectSpec& effect) {
  const std::set<std::string> meant = check_parameter_names(reading, type, path);
  if (const std::string key = join_path(path, "body"); reading.bodies > 1 && !reading.silent_on(key)) {
    const double last = static_cast<double>(reading.bodies) - (type.couples() ? 2.0 : 1.0);
    const auto value = reading.take(key, "`body` of the effect " + type.name,
                                    {.type = ValueType::integer, .minimum = 0.0, .maximum = last});
    if (value) effect.body = std::get<std::int64_t>(*value);
  }
  for (const EffectParameter& parameter : type.parameters) {
    const ValueRule rule = rule_of(parameter);
    const std::string key = join_path(path, parameter.name);
    const std::string label = '`' + parameter.name + "` of the effect " + type.name;
    if (!reading.silent_on(key)) {
      const auto value = reading.take(key, label, rule);
      if (value) effect.parameters[parameter.name] = parameter_value(*value);
    } else if (parameter.default_value) {
      effect.parameters[parameter.name] = *parameter.default_value;
    } else if (!meant.contains(parameter.name)) {
      reading.report(effect.origin, label + " is missing; it must be " + demand(rule));
    }
  }
}

std::string said_as(const Reading& reading, const std::string& key) {
  const auto* const word = std::get_if<std::string>(&reading.said.values.at(key).content);
  return word != nullptr ? *word : "";
}

// What acts on an end that does not move would do nothing.
void check_end(Reading& reading, const EffectSpec& effect, const std::string& path) {
  if (!concerns(reading, effect)) return;
  const EffectType& type = find_effect(reading.scene, effect);
  for (const std::string end : {"left", "right"}) {
    const auto parameter = effect.parameters.find("end");
    const bool named =
        parameter != effect.parameters.end() && std::get<std::string>(parameter->second) == end;
    if (!named && !(type.couples() && type.holds(effect, end, reading.body, reading.bodies))) continue;
    const std::string key = "ends." + end;
    const bool known = reading.has(key) || reading.silent_on(key);
    const bool fixed = (end == "left" ? reading.scene.ends.left : reading.scene.ends.right) == End::fixed;
    if (known && fixed)
      reading.report(reading.said.where(path + ".end"),
                     "the effect " + effect.type + " acts on a free end; " + key +
                         (reading.bodies > 1 ? " of body " + std::to_string(reading.body) : "") +
                         " is fixed");
  }
}

}  // namespace

void check_effects(Reading& reading) {
  for (const EffectSpec& effect : reading.scene.effects) {
    const EffectType& type = find_effect(reading.scene, effect);
    if (type.couples() && reading.bodies == 1)
      reading.report(effect.origin,
                     "the effect " + effect.type + " is between two bodies; the scene has one");
    if (!concerns(reading, effect)) continue;
    if (type.conflict == nullptr || effect.parameters.size() < type.parameters.size()) continue;
    if (const std::string reason = type.conflict(effect, reading.scene); !reason.empty())
      reading.report(effect.origin, "the effect " + effect.type + " does not go with this scene: " + reason);
  }
}

void read_effects(Reading& reading) {
  const ValueRule rule = type_rule(reading.scene);
  for (std::size_t index = 0; !reading.silent_on(effect_path(index)); ++index) {
    const std::string path = effect_path(index);
    const SaidValue& table = reading.said.values.at(path);
    if (!std::holds_alternative<TomlTable>(table.content)) {
      reading.report(table.value, "an effect must be a table, [[effect]], not " + shown(table.content));
      continue;
    }
    EffectSpec effect{"", {}, table.value};
    reading.scene.origins[path] = table.value;
    const std::string type_key = path + ".type";
    if (reading.silent_on(type_key)) {
      reading.report(table.value, "the `type` of the effect is missing; it must be " + demand(rule));
    } else if (said_as(reading, type_key) == "plasticity") {
      reading.report(
          reading.said.where(type_key),
          "plasticity is a law now: write law = \"elastoplastic\", yield_stress and tangent_modulus "
          "into [material]");
    } else if (const auto type = reading.take(type_key, "the `type` of an effect", rule)) {
      effect.type = std::get<std::string>(*type);
      read_parameters(reading, find_effect(reading.scene, effect), path, effect);
      check_end(reading, effect, path);
      reading.scene.effects.push_back(std::move(effect));
    }
  }
}

}  // namespace hompm::detail
