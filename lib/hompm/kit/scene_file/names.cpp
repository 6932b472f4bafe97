// Names that a scene cannot have, and what was probably meant.
#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <hompm/kit/scene_file/keys.hpp>
#include <hompm/kit/scene_file/reading.hpp>

namespace hompm::detail {
namespace {

std::string place(const std::string& table) {
  return table.empty() ? "outside any table" : "in [" + printable(table) + ']';
}

std::vector<std::string> all_paths() {
  std::vector<std::string> paths;
  for (const KeyRow& row : key_table()) paths.push_back(row.path);
  return paths;
}

// The key or table of this name in another table: what was said stands in the wrong place.
std::string elsewhere(const std::string& name) {
  for (const std::string& path : all_paths()) {
    if (last_name(path) == name) return path;
    std::string table = parent_path(path);
    if (table.find('.') != std::string::npos && last_name(table) == name) return table;
  }
  return "";
}

/// Keys by the symbols of the field.
std::string by_symbol(const std::string& symbol) {
  for (const auto& [name, path] : {std::pair{"E", "material.youngs_modulus"},
                                   {"rho", "material.density"},
                                   {"ρ", "material.density"},
                                   {"dt", "scheme.time_step"},
                                   {"T", "end_time"},
                                   {"t_end", "end_time"},
                                   {"H", "body.length"},
                                   {"L", "body.length"},
                                   {"ppc", "scheme.particles_per_cell"},
                                   {"p", "scheme.degree"}})
    if (symbol == name) return path;
  return "";
}

bool is_effect(const Reading& reading, const std::string& name) {
  return std::ranges::any_of(effects_of(reading.scene),
                             [&](const EffectType& type) { return type.name == name; });
}

void report_unknown_option(Reading& reading, const std::string& path, const SaidValue& value) {
  std::string near = by_symbol(value.name);
  if (near.empty()) near = nearest(path, all_paths());
  if (near.empty()) near = elsewhere(value.name);
  const std::string hint = near.empty() ? "" : "; did you mean `" + near + "`?";
  if (!near.empty()) reading.meant.insert(near);
  reading.report(value.key, "unknown key `" + printable(path) + '`' + hint);
}

void report_unknown(Reading& reading, const std::string& path, const SaidValue& value) {
  if (value.key.source != reading.said.source) return report_unknown_option(reading, path, value);
  const bool table = std::holds_alternative<TomlTable>(value.content);
  std::string message = table ? "unknown table [" + printable(path) + ']'
                              : "unknown key `" + printable(value.name) + "` " + place(value.parent);
  const std::vector<std::string> names = names_in(value.parent);
  std::string meant = nearest(value.name, names);
  if (const std::string key = table ? "" : by_symbol(value.name); !key.empty()) {
    meant = key;
    message += "; did you mean `" + last_name(key) + '`' +
               (parent_path(key) == value.parent ? "" : " " + place(parent_path(key))) + '?';
  } else if (value.name == "g" && !table) {
    meant = "";
    message += "; gravity is written [[effect]] with type = \"gravity\" and acceleration = -9.81";
  } else if (!meant.empty()) {
    meant = join_path(value.parent, meant);
    message += table ? "; did you mean [" + meant + "]?" : "; did you mean `" + last_name(meant) + "`?";
  } else if (meant = elsewhere(value.name); !meant.empty()) {
    message += table ? "; did you mean [" + meant + "]?" : "; it belongs " + place(parent_path(meant));
  } else if (is_effect(reading, value.name)) {
    message += "; an effect is written [[effect]] with type = \"" + value.name + '"';
  } else {
    message += "; known here: " + listed(names);
  }
  if (!meant.empty()) reading.meant.insert(meant);
  reading.report(value.key, message);
}

// Reports a table that is not one; true when its keys can be looked at.
bool check_table(Reading& reading, const std::string& path, const SaidValue& value) {
  if (std::holds_alternative<TomlTable>(value.content)) return true;
  reading.meant.insert(path);
  reading.report(value.value, '`' + path + "` must be a table, [" + path + "], not " + shown(value.content));
  return false;
}

void check_list(Reading& reading, const std::string& name, const SaidValue& value) {
  if (std::holds_alternative<Array>(value.content)) return;
  const bool table = std::holds_alternative<TomlTable>(value.content);
  reading.report(value.value, name + "s are a list: write [[" + name + "]], one for each, instead of " +
                                  (table ? '[' + name + ']' : shown(value.content)));
}

}  // namespace

std::set<std::string> check_names_in(Reading& reading, const std::string& path,
                                     const std::vector<std::string>& names, const std::string& what) {
  std::set<std::string> meant;
  for (const auto& [key, value] : reading.said.values) {
    if (value.parent != path || std::ranges::find(names, value.name) != names.end()) continue;
    const std::string near = nearest(value.name, names);
    meant.insert(near);
    reading.report(value.key,
                   "unknown key `" + printable(value.name) + "` of " + what +
                       (near.empty() ? "; it has " + listed(names) : "; did you mean `" + near + "`?"));
  }
  return meant;
}

void check_names(Reading& reading) {
  std::set<std::string> settled;  // what lies below these is not looked at here
  for (const auto& [path, value] : reading.said.values) {
    const bool from_file = value.key.source == reading.said.source;
    const bool in_list = path.starts_with("effect[") || path.starts_with("probe[");
    if (settled.contains(value.parent) && (from_file || in_list)) {
      settled.insert(path);
    } else if (path == "effect" || path == "probe") {
      check_list(reading, path, value);
      settled.insert(path);
    } else if (find_key(path) != nullptr) {
      settled.insert(path);
    } else if (!is_table(path)) {
      report_unknown(reading, path, value);
      settled.insert(path);
    } else if (!check_table(reading, path, value)) {
      settled.insert(path);
    }
  }
}

}  // namespace hompm::detail
