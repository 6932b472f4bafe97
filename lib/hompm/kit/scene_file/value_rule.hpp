// One value of a scene file: as it was said, as TOML text, and what a key accepts: its type, unit, range and
// words, and how to say so.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <hompm/effects/registry.hpp>

namespace hompm::detail {

// What TOML has and no key of a scene can hold.
// LCOV_EXCL_START: asked for by the comparison of Content, in which no key has one
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
// LCOV_EXCL_STOP

using Content = std::variant<bool, std::int64_t, double, std::string, TomlTable, Array, Moment>;

/// A number as a TOML float, shortest round trip: "25.0", "1e-04"; "nan" and "inf" as TOML spells them.
std::string toml_number(double value);

/// A text as a TOML basic string, quotes included.
std::string toml_string(const std::string& text);

/// Part of a message on one line: control characters escaped, a text of more than `longest` bytes cut short.
std::string printable(const std::string& text, std::size_t longest = 60);

/// A value for a message: as TOML, cut short when long.
std::string shown(const Content& content);

enum class ValueType { number, integer, boolean, word, text };

struct ValueRule {
  ValueType type = ValueType::number;
  std::string unit{};  ///< SI; "" for none
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool minimum_excluded = false;
  std::vector<std::string> words{};  ///< of a word
};

/// The rule of a parameter of an effect.
ValueRule rule_of(const EffectParameter& parameter);

/// The value of a parameter as TOML text.
std::string toml_value(const EffectSpec::Value& value);

/// "number", "integer", …
std::string type_name(ValueType type);

/// The range for a table of keys: "> 0", "1 … 5", "fixed, free"; "" where anything goes.
std::string range_text(const ValueRule& rule);

/// What a value must be, to follow "must be": "a whole number from 1 to 5", "a number greater than 0 (m)".
std::string demand(const ValueRule& rule);

/// The content as the type of the rule holds it (a whole number given for a number becomes a double, and a
/// text such as "25 kPa" the number in the unit of the rule); nothing where the rule forbids it.
std::optional<Content> accepted(const ValueRule& rule, const Content& content);

/// "a, b, c", cut short ("a, b and 7 more") where there are more than 15
std::string listed(const std::vector<std::string>& words);

}  // namespace hompm::detail
