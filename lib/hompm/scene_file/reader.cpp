#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <variant>

#include <hompm/scene_file/keys.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/scene_file/reading.hpp>

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

}  // namespace
}  // namespace detail

Scene parse_scene(const std::string& text, const std::string& source, const std::vector<Override>& overrides,
                  const EffectCatalogue& effects) {
  detail::Reading reading{.said = detail::read_toml(text, source)};
  reading.scene.effect_types = &effects;
  detail::apply_overrides(reading, overrides);
  if (const std::size_t bodies = detail::count_bodies(reading); bodies > 0)
    detail::read_bodies(reading, bodies);
  else
    detail::read_body(reading);
  if (!reading.problems.empty()) {
    detail::sort_by_position(reading.problems, source);
    throw SceneError(std::move(reading.problems));
  }
  return std::move(reading.scene);
}

Scene load_scene(const std::string& path, const std::vector<Override>& overrides,
                 const EffectCatalogue& effects) {
  constexpr std::size_t largest = 4U << 20U;  // more than any scene needs
  return parse_scene(read_file(path, largest), detail::printable(path, path.size()), overrides, effects);
}

}  // namespace hompm
