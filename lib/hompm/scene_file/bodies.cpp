// A scene of several bodies: each is read as a scene of its own.
#include <algorithm>
#include <array>
#include <string_view>

#include <hompm/effects/registry.hpp>
#include <hompm/scene_file/keys.hpp>
#include <hompm/scene_file/reading.hpp>

namespace hompm::detail {
namespace {

constexpr std::size_t most_bodies = 1000;
constexpr std::array own_of_scheme{"cells", "particles_per_cell", "margin_cells", "relaxation_rate"};
constexpr std::array own_tables{"material", "initial", "ends", "grid"};

/// Where in a scene of one body the key of a body stands.
std::string place_of_key(const std::string& key) {
  const std::string first = key.substr(0, key.find('.'));
  if (std::ranges::find(own_of_scheme, first) != own_of_scheme.end()) return "scheme." + key;
  if (std::ranges::find(own_tables, first) != own_tables.end()) return key;
  return "body." + key;
}

std::string path_of(std::size_t body) { return "body[" + std::to_string(body) + ']'; }

bool is_of_bodies(const std::string& path) { return path == "body" || path.starts_with("body["); }

}  // namespace

std::vector<Said> said_of_bodies(Reading& reading) {
  auto& values = reading.said.values;
  const SaidValue* list = reading.said.find("body");
  if (list == nullptr || !std::holds_alternative<Array>(list->content)) return {};
  std::size_t count = 0;
  while (values.contains(path_of(count))) ++count;
  std::vector<Said> bodies;
  if (count == 0 || count > most_bodies) {
    reading.report(list->value, "there must be 1 to " + std::to_string(most_bodies) +
                                    " [[body]] tables, not " + std::to_string(count));
    return {};
  }
  for (std::size_t body = 0; body < count; ++body) {
    const std::string own = path_of(body);
    Said said{reading.said.source, {}};
    for (const auto& [path, value] : values)
      if (!is_of_bodies(path)) said.values[path] = value;
    for (const auto& [path, value] : values) {
      if (path == own) said.values["body"] = value;
      if (!path.starts_with(own + '.')) continue;
      const std::string to = place_of_key(path.substr(own.size() + 1));
      SaidValue moved = value;
      moved.parent = parent_path(to);
      said.values[to] = std::move(moved);
    }
    bodies.push_back(std::move(said));
  }
  for (const auto& [path, value] : values) {
    const std::string whose = path.substr(0, path.find(']') + 1);
    if (path.starts_with("body[") && path != whose && !values.contains(whose))
      reading.report(value.key, "the scene has no " + printable(whose) + "; it has " + std::to_string(count) +
                                    " bodies, from body[0]");
  }
  return bodies;
}

std::string name_in_body(const std::string& path) {
  const std::string first = path.substr(0, path.find('.'));
  if (first == "body") return last_name(path);
  if (std::ranges::find(own_tables, first) != own_tables.end()) return path;
  const bool own =
      first == "scheme" && std::ranges::find(own_of_scheme, last_name(path)) != own_of_scheme.end();
  return own ? last_name(path) : "";
}

bool concerns(const Reading& reading, const EffectSpec& effect) {
  const EffectType& type = find_effect(reading.scene, effect);
  if (!type.couples()) return effect.body.value_or(reading.body) == reading.body;
  return type.holds(effect, "left", reading.body, reading.bodies) ||
         type.holds(effect, "right", reading.body, reading.bodies);
}

}  // namespace hompm::detail
