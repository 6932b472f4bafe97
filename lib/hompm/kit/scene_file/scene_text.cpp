// The resolved scene as TOML.

#include <string>

#include <hompm/kit/scene_file/keys.hpp>
#include <hompm/kit/scene_file/reading.hpp>

namespace hompm {
namespace {

std::string line(const std::string& name, const std::string& value, const std::string& unit) {
  return name + " = " + value + (unit.empty() ? "" : "  # " + unit) + '\n';
}

std::string unit_of(const Scene& scene, const std::string& effect, const std::string& parameter) {
  for (const EffectType& type : effects_of(scene)) {
    if (type.name != effect) continue;
    for (const EffectParameter& row : type.parameters) {
      if (row.name == parameter) return detail::rule_of(row).unit;
    }
  }
  return "";
}

std::string effect_text(const Scene& scene, const EffectSpec& effect) {
  std::string text = "\n[[effect]]\n" + line("type", detail::toml_string(effect.type), "");
  if (effect.body) text += line("body", std::to_string(*effect.body), "");
  for (const auto& [name, value] : effect.parameters)
    text += line(name, detail::toml_value(value), unit_of(scene, effect.type, name));
  return text;
}

std::string body_text(Scene body) {
  std::string text = "\n[[body]]\n";
  for (const detail::KeyRow& row : detail::key_table()) {
    const std::string name = detail::name_in_body(row.path);
    const auto* optional = detail::find_optional_table(detail::parent_path(row.path));
    if (name.empty() || (optional != nullptr && !optional->present(body))) continue;
    if (const std::string value = detail::load_text(row, body); !value.empty())
      text += line(name, value, row.rule.unit);
  }
  return text;
}

}  // namespace

std::string scene_text(const Scene& scene) {
  Scene copy = scene;  // the key table points into a scene that it may change
  const bool several = !scene.bodies.empty();
  std::string text;
  std::string table;
  for (const detail::KeyRow& row : detail::key_table()) {
    if (several && !detail::name_in_body(row.path).empty()) continue;
    const std::string parent = detail::parent_path(row.path);
    const auto* optional = detail::find_optional_table(parent);
    if (optional != nullptr && !optional->present(scene)) continue;
    const std::string value = detail::load_text(row, copy);
    if (value.empty() || (row.absent == detail::Absent::seldom && value == row.standard)) continue;
    if (parent != table) {
      if (table == "ends") {
        for (const EffectSpec& effect : scene.effects) text += effect_text(scene, effect);
      }
      text += "\n[" + parent + "]\n";
      table = parent;
    }
    text += line(detail::last_name(row.path), value, row.rule.unit);
  }
  for (const Scene& body : scene.bodies) text += body_text(body);
  if (several)
    for (const EffectSpec& effect : scene.effects) text += effect_text(scene, effect);
  for (const ProbeSpec& probe : scene.probes) text += detail::probe_text(probe);
  return text;
}

}  // namespace hompm
