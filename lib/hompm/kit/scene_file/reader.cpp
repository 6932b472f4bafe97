#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <variant>

#include <hompm/kit/scene_file/keys.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/scene_file/reading.hpp>
#include <hompm/kit/scene_file/units.hpp>

namespace hompm {
namespace detail {

void Reading::report(const Origin& origin, std::string message) {
  problems.push_back({origin, std::move(message)});
}

std::optional<Content> Reading::take(const std::string& path, const std::string& label,
                                     const ValueRule& rule) {
  const SaidValue& value = said.values.at(path);
  std::optional<Content> content = accepted(rule, value.content);
  if (content) {
    scene.origins[path] = value.key;
    return content;
  }
  std::string message = label + " must be " + demand(rule) + ", not " + shown(value.content);
  if (const auto* text = std::get_if<std::string>(&value.content)) {
    const std::string near = nearest(*text, rule.words);
    if (!near.empty()) message += "; did you mean \"" + near + "\"?";
    const std::string reason = rule.type == ValueType::number ? converted(*text, rule.unit).reason : "";
    if (!reason.empty()) message += ": " + reason;
  }
  report(value.value, std::move(message));
  return std::nullopt;
}

void read_keys(Reading& reading) {
  for (const KeyRow& row : key_table()) {
    const std::string table = parent_path(row.path);
    if (const OptionalTable* optional = find_optional_table(table)) {
      const auto below = reading.said.values.lower_bound(table + '.');
      if (below == reading.said.values.end() || below->second.parent != table) continue;
      if (!optional->present(reading.scene)) optional->create(reading.scene);
    }
    if (reading.said.find(row.path) != nullptr) {
      const auto value = reading.take(row.path, '`' + row.path + '`', row.rule);
      if (value) store(row, *value, reading.scene);
    } else if (row.absent == Absent::standard || row.absent == Absent::seldom) {
      store(row, accepted(row.rule, parse_value(row.standard)).value(), reading.scene);
    } else if (row.absent == Absent::missing && !reading.meant.contains(row.path) &&
               !reading.meant.contains(table)) {
      reading.report(reading.said.where(table),
                     '`' + row.path + "` is missing; it must be " + demand(row.rule));
    }
  }
}

namespace {

// Options come after the file, in the order in which they were found wrong.
void sort_by_position(std::vector<Problem>& problems, const std::string& file) {
  const auto position = [&](const Problem& problem) {
    return std::tuple(problem.origin.source != file, problem.origin.line, problem.origin.column);
  };
  std::stable_sort(problems.begin(), problems.end(),
                   [&](const Problem& a, const Problem& b) { return position(a) < position(b); });
}

void read_body(Reading& reading) {
  check_names(reading);
  read_keys(reading);
  read_effects(reading);
  complete(reading);
  check_effects(reading);
}

/// The scene of the first body with the scenes of all. What is wrong with what they share is said once.
void read_bodies(Reading& reading, std::size_t count) {
  constexpr std::size_t enough = 100;  // problems, to leave those of further bodies for later
  std::vector<Scene> scenes;
  std::set<std::string> told;
  const EffectCatalogue* effects = reading.scene.effect_types;
  for (std::size_t body = 0; body < count && reading.problems.size() <= enough; ++body) {
    Reading own{.said = said_of_body(reading.said, body),
                .body = static_cast<std::int64_t>(body),
                .bodies = static_cast<std::int64_t>(count)};
    own.scene.effect_types = effects;
    read_body(own);
    for (Problem& problem : own.problems)
      if (told.insert(problem.origin.text() + ' ' + problem.message).second)
        reading.problems.push_back(std::move(problem));
    if (body == 0) {
      own.scene.warnings = std::move(reading.scene.warnings);
      reading.scene = own.scene;
    }
    std::erase_if(own.scene.effects, [&](const EffectSpec& effect) { return !concerns(own, effect); });
    scenes.push_back(std::move(own.scene));
  }
  for (const Scene& scene : scenes)
    if (reading.problems.empty() && scene.kinematics != scenes.front().kinematics)
      reading.report(
          scene.origins.at("material.law"),
          "all bodies must have the same kinematics: those of their laws are infinitesimal and finite");
  if (scenes.size() > 1) reading.scene.bodies = std::move(scenes);
}

/// What code says of a scene, each value at its key, in tables and lists as a file would have them.
Said said_in_code(const std::vector<std::pair<std::string, SceneValue>>& keys) {
  Said said{"scene", {}};
  const auto add = [&](const std::string& path, const std::string& parent, Content content) {
    const Origin origin{path};
    return said.values.emplace(path, SaidValue{std::move(content), parent, last_name(path), origin, origin})
        .second;
  };
  std::map<std::string, int> elements;  // of each list so far
  for (const auto& [path, value] : keys) {
    for (std::string table = parent_path(path); !table.empty(); table = parent_path(table)) {
      const std::string list = table.ends_with(']') ? table.substr(0, table.rfind('[')) : parent_path(table);
      const bool first = add(table, list, TomlTable{});
      if (!first || !table.ends_with(']')) continue;
      add(list, parent_path(list), Array{});
      const std::string next = list + '[' + std::to_string(elements[list]++) + ']';
      if (table != next)
        throw SceneError(Origin{path}, "comes before " + next + ": elements are given in their order");
    }
    if (!add(path, parent_path(path), std::visit([](const auto& given) { return Content(given); }, value)))
      throw SceneError(Origin{path}, "is given twice");
  }
  return said;
}

Scene scene_of(Said said, const std::vector<Override>& overrides, const EffectCatalogue& effects) {
  Reading reading{.said = std::move(said)};
  reading.scene.effect_types = &effects;
  apply_overrides(reading, overrides);
  if (const std::size_t bodies = count_bodies(reading); bodies > 0)
    read_bodies(reading, bodies);
  else
    read_body(reading);
  read_probes(reading);
  if (!reading.problems.empty()) {
    sort_by_position(reading.problems, reading.said.source);
    throw SceneError(std::move(reading.problems));
  }
  return std::move(reading.scene);
}

}  // namespace
}  // namespace detail

Scene parse_scene(const std::string& text, const std::string& source, const std::vector<Override>& overrides,
                  const EffectCatalogue& effects) {
  return detail::scene_of(detail::read_toml(text, source), overrides, effects);
}

Scene make_scene(const std::vector<std::pair<std::string, SceneValue>>& keys,
                 const EffectCatalogue& effects) {
  return detail::scene_of(detail::said_in_code(keys), {}, effects);
}

Scene load_scene(const std::string& path, const std::vector<Override>& overrides,
                 const EffectCatalogue& effects) {
  constexpr std::size_t largest = 4U << 20U;  // more than any scene needs
  return parse_scene(read_file(path, largest), detail::printable(path, path.size()), overrides, effects);
}

}  // namespace hompm
