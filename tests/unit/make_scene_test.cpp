// Scenes made in code are those of files.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include <hompm/kit/scene_file/reader.hpp>

#include "support/catch.hpp"

using namespace hompm;

namespace {

using Keys = std::vector<std::pair<std::string, SceneValue>>;

/// The keys and values of a file, as code would give them.
void flatten(const toml::node& node, const std::string& path, Keys& keys) {
  if (const auto* table = node.as_table()) {
    for (const auto& [name, value] : *table)
      flatten(value, path.empty() ? std::string(name.str()) : path + '.' + std::string(name.str()), keys);
  } else if (const auto* array = node.as_array()) {
    for (std::size_t i = 0; i < array->size(); ++i)
      flatten(*array->get(i), path + '[' + std::to_string(i) + ']', keys);
  } else if (const auto* number = node.as_floating_point()) {
    keys.emplace_back(path, number->get());
  } else if (const auto* whole = node.as_integer()) {
    keys.emplace_back(path, whole->get());
  } else if (const auto* truth = node.as_boolean()) {
    keys.emplace_back(path, truth->get());
  } else {
    keys.emplace_back(path, node.as_string()->get());
  }
}

Keys keys_of(const std::string& text) {
  Keys keys;
  flatten(toml::parse(text), "", keys);
  return keys;
}

const Keys plain{{"end_time", 0.1},          {"body.length", 1},  // a whole number does for a number
                 {"material.law", "linear"}, {"material.density", 1000.0}, {"material.youngs_modulus", 1e5},
                 {"scheme.name", "bspline"}, {"scheme.cells", 8},          {"scheme.particles_per_cell", 2},
                 {"scheme.courant", 0.1}};

std::string complaint(Keys more, const std::string& without = "") {
  Keys keys = plain;
  std::erase_if(keys, [&](const auto& key) { return key.first == without; });
  keys.insert(keys.end(), more.begin(), more.end());
  try {
    make_scene(keys);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("the keys of each built-in scene make that scene") {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    CAPTURE(builtin.case_name, builtin.variant);
    CHECK(scene_text(make_scene(keys_of(builtin.text))) == scene_text(parse_scene(builtin.text, "file", {})));
  }
}

TEST_CASE("several bodies can be made in code") {
  const std::string text = R"(
case = "two"
end_time = 0.1
[[body]]
length = 1.0
[[body]]
length = 0.5
start = 1.1
initial.velocity = {shape = "uniform", amplitude = -0.1}
[material]
law = "linear"
density = 1000.0
youngs_modulus = 1e5
[ends]
left = "free"
right = "free"
[[effect]]
type = "contact"
[scheme]
name = "bspline"
cells = 8
particles_per_cell = 2
courant = 0.1
)";
  CHECK(scene_text(make_scene(keys_of(text))) == scene_text(parse_scene(text, "file", {})));
}

TEST_CASE("messages on a scene made in code name its keys") {
  CHECK(complaint({}).empty());
  CHECK(complaint({{"material.dansity", 1.0}}, "material.density") ==
        "material.dansity: unknown key `material.dansity`; did you mean `material.density`?");
  CHECK(complaint({}, "material.law").starts_with("material: `material.law` is missing; it must be "));
  CHECK(complaint({{"scheme.degree", 9}}) ==
        "scheme.degree: `scheme.degree` must be a whole number from 1 to 5 with the scheme bspline, not 9");
  CHECK(complaint({{"end_time", 0.2}}) == "end_time: is given twice");
  CHECK(complaint({{"effect[1].type", "gravity"}}) ==
        "effect[1].type: comes before effect[0]: elements are given in their order");
  CHECK(complaint({{"effect[0].type", "gravty"}}).ends_with("; did you mean \"gravity\"?"));
  CHECK(complaint({{"body.start", "here"}}).starts_with("body.start: `body.start` must be a finite number"));
}
