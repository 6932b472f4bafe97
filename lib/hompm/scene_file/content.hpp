// One value of a scene file as it was said, and values as TOML text.
#pragma once

#include <cstdint>
#include <string>
#include <variant>

namespace hompm::detail {

// What TOML has and no key of a scene can hold.
struct TomlTable {
  bool operator==(const TomlTable&) const = default;
};
struct Array {
  bool operator==(const Array&) const = default;
};
/// A date or a time.
struct Moment {
  bool operator==(const Moment&) const = default;
};

using Content = std::variant<bool, std::int64_t, double, std::string, TomlTable, Array, Moment>;

/// A number as a TOML float, shortest round trip: "25.0", "1e-04"; "nan" and "inf" as TOML spells them.
std::string toml_number(double value);

/// A text as a TOML basic string, quotes included.
std::string toml_string(const std::string& text);

/// Part of a message on one line: control characters escaped, a text of more than `longest` bytes cut short.
std::string printable(const std::string& text, std::size_t longest = 60);

/// A value for a message: as TOML, cut short when long.
std::string shown(const Content& content);

}  // namespace hompm::detail
