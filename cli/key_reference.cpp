#include "key_reference.hpp"

#include <nlohmann/json.hpp>

#include <hompm/effects/registry.hpp>
#include <hompm/scene_file/reader.hpp>

namespace hompm::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string values(const SceneKey& key) {
  std::string text = key.type == "integer" ? "whole number" : key.type;
  if (key.type == "word" || key.type == "boolean")
    text = key.range;
  else if (!key.range.empty())
    text += ", " + key.range;
  return key.condition.empty() ? text : text + " (" + key.condition + ")";
}

std::string standard(const SceneKey& key) {
  if (key.required)
    return "; must be given" + (key.optional_table.empty() ? "" : " where [" + key.optional_table + "] is");
  return key.standard.empty() ? "" : "; default: " + key.standard;
}

std::string lines(const SceneKey& key, const std::string& indent) {
  return indent + key.path + (key.unit.empty() ? "" : " [" + key.unit + "]") + ": " + values(key) +
         standard(key) + "\n" + indent + "    " + key.meaning + "\n";
}

Json json(const SceneKey& key) {
  return {{"path", key.path},         {"type", key.type},
          {"unit", key.unit},         {"range", key.range},
          {"words", key.words},       {"condition", key.condition},
          {"required", key.required}, {"optional_table", key.optional_table},
          {"default", key.standard},  {"meaning", key.meaning}};
}

}  // namespace

std::string key_text() {
  std::string text;
  for (const SceneKey& key : scene_keys()) text += lines(key, "");
  for (const EffectType& effect : effect_catalogue()) {
    text += "\n[[effect]] type = \"" + effect.name + "\"\n    " + effect.meaning + "\n";
    for (const SceneKey& key : parameter_keys(effect)) text += lines(key, "  ");
  }
  return text;
}

std::string key_json() {
  Json all{{"keys", Json::array()}, {"effects", Json::array()}};
  for (const SceneKey& key : scene_keys()) all["keys"].push_back(json(key));
  for (const EffectType& effect : effect_catalogue()) {
    Json parameters = Json::array();
    for (const SceneKey& key : parameter_keys(effect)) parameters.push_back(json(key));
    all["effects"].push_back(
        {{"name", effect.name}, {"meaning", effect.meaning}, {"parameters", parameters}});
  }
  return all.dump(2) + "\n";
}

}  // namespace hompm::cli
