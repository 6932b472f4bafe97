// A scene of several bodies: each is read as a scene of its own.
#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>
#include <variant>

#include <hompm/kit/scene_file/keys.hpp>
#include <hompm/kit/scene_file/reading.hpp>

namespace hompm::detail {
namespace {

constexpr std::size_t most_bodies = 1000;
constexpr std::size_t most_pairs = 100'000;  // of a body and an effect
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

std::size_t count_bodies(Reading& reading) {
  const auto& values = reading.said.values;
  const SaidValue* list = reading.said.find("body");
  if (list == nullptr || !std::holds_alternative<Array>(list->content)) return 0;
  std::set<std::string> bodies;
  while (values.contains(path_of(bodies.size()))) bodies.insert(path_of(bodies.size()));
  const std::size_t count = bodies.size();
  std::size_t effects = 0;
  while (values.contains(effect_path(effects))) ++effects;
  if (count == 0 || count > most_bodies) {
    reading.report(list->value, "there must be 1 to " + std::to_string(most_bodies) +
                                    " [[body]] tables, not " + std::to_string(count));
    return 0;
  }
  if (count * effects > most_pairs) {
    reading.report(list->value, "with " + std::to_string(count) + " [[body]] tables there must be at most " +
                                    std::to_string(most_pairs / count) + " [[effect]] tables, not " +
                                    std::to_string(effects));
    return 0;
  }
  for (const auto& [path, value] : values) {
    const std::string whose = path.substr(0, path.find('.'));
    if (path.starts_with("body[") && !bodies.contains(whose))
      reading.report(value.key, "the scene has no " + printable(whose) + "; it has " + std::to_string(count) +
                                    " bodies, from body[0]");
  }
  return count;
}

Said said_of_body(const Said& all, std::size_t body) {
  const std::string own = path_of(body);
  Said said{all.source, {}};
  for (const auto& [path, value] : all.values)
    if (!is_of_bodies(path)) said.values[path] = value;
  said.values["body"] = all.values.at(own);
  const std::string below = own + '.';
  for (auto at = all.values.lower_bound(below); at != all.values.end() && at->first.starts_with(below);
       ++at) {
    const std::string to = place_of_key(at->first.substr(below.size()));
    SaidValue moved = at->second;
    moved.parent = parent_path(to);
    said.values[to] = std::move(moved);
  }
  return said;
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
