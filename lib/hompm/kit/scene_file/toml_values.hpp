// A TOML text as a flat map from dotted path to value, with the place where each was said.
#pragma once

#include <map>
#include <string>

#include <hompm/kit/scene_file/value_rule.hpp>

namespace hompm::detail {

struct SaidValue {
  Content content;
  std::string parent;  ///< path of the table that holds it; "" at the top
  std::string name;    ///< the key as written
  Origin key;          ///< where the key stands
  Origin value;        ///< where the value stands; of a table, its header
};

/// Everything a scene says. Tables are entries too. Nothing deeper than any key of a scene is recorded.
struct Said {
  std::string source;
  std::map<std::string, SaidValue> values;

  /// The entry at `path`, or null.
  [[nodiscard]] const SaidValue* find(const std::string& path) const;
  /// Where the value of `path` was said; of a key that was not, the table it belongs to; failing that, the
  /// file.
  [[nodiscard]] Origin where(const std::string& path) const;
};

/// `parent.name`, or `name` at the top.
std::string join_path(const std::string& parent, const std::string& name);

/// The path without its last name: "initial" for "initial.velocity", "" for "title".
std::string parent_path(const std::string& path);

/// The last name of a path: "velocity" for "initial.velocity".
std::string last_name(const std::string& path);

/// Path of the `index`-th table of a list, counting from 0: "effect[2]".
std::string list_path(const std::string& list, std::size_t index);
inline std::string effect_path(std::size_t index) { return list_path("effect", index); }

/// Flattens `text`. Throws `SceneError` with one problem where it is not TOML.
Said read_toml(const std::string& text, const std::string& source);

/// A value given on the command line: TOML, or a bare word, which is a string.
Content parse_value(const std::string& text);

}  // namespace hompm::detail
