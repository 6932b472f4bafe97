// What the reader knows of its keys, for those who document them.
#include <hompm/scene_file/keys.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/scene_file/toml_values.hpp>

namespace hompm {
namespace {

SceneKey key_of(const std::string& path, const detail::ValueRule& rule) {
  return {.path = path,
          .type = detail::type_name(rule.type),
          .unit = rule.unit,
          .range = detail::range_text(rule),
          .words = rule.words};
}

}  // namespace

const std::vector<SceneKey>& scene_keys() {
  static const std::vector<SceneKey> keys = [] {
    std::vector<SceneKey> all;
    for (const detail::KeyRow& row : detail::key_table()) {
      SceneKey key = key_of(row.path, row.rule);
      key.condition = row.condition;
      if (const auto* table = detail::find_optional_table(detail::parent_path(row.path)))
        key.optional_table = table->path;
      key.required = row.absent == detail::Absent::missing;
      key.standard = row.standard;
      key.meaning = row.meaning;
      all.push_back(std::move(key));
    }
    return all;
  }();
  return keys;
}

std::vector<SceneKey> parameter_keys(const EffectType& effect) {
  std::vector<SceneKey> keys;
  for (const EffectParameter& parameter : effect.parameters) {
    SceneKey key = key_of(parameter.name, detail::rule_of(parameter));
    key.required = !parameter.default_value.has_value();
    if (parameter.default_value) key.standard = detail::toml_value(*parameter.default_value);
    key.meaning = parameter.meaning;
    keys.push_back(std::move(key));
  }
  return keys;
}

}  // namespace hompm
