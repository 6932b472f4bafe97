#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>

#include <hompm/kit/scene_file/units.hpp>
#include <hompm/kit/scene_file/value_rule.hpp>

namespace hompm::detail {
namespace {

/// Powers of kilogram, metre, second and ten.
struct Unit {
  int kg = 0, m = 0, s = 0, ten = 0;
  [[nodiscard]] bool same_dimension(const Unit& other) const {
    return kg == other.kg && m == other.m && s == other.s;
  }
};

constexpr std::array<std::pair<std::string_view, Unit>, 9> symbols{{{"kg", {1, 0, 0, 0}},
                                                                    {"g", {1, 0, 0, -3}},
                                                                    {"t", {1, 0, 0, 3}},
                                                                    {"m", {0, 1, 0, 0}},
                                                                    {"s", {0, 0, 1, 0}},
                                                                    {"Hz", {0, 0, -1, 0}},
                                                                    {"N", {1, 1, -2, 0}},
                                                                    {"Pa", {1, -1, -2, 0}},
                                                                    {"J", {1, 2, -2, 0}}}};
constexpr std::array<std::pair<std::string_view, int>, 9> prefixes{
    {{"", 0}, {"G", 9}, {"M", 6}, {"k", 3}, {"c", -2}, {"m", -3}, {"µ", -6}, {"μ", -6}, {"u", -6}}};

std::optional<Unit> symbol(std::string_view text) {
  for (const auto& [name, unit] : symbols)
    for (const auto& [prefix, ten] : prefixes)
      if (text.starts_with(prefix) && text.substr(prefix.size()) == name)
        return Unit{unit.kg, unit.m, unit.s, unit.ten + ten};
  return std::nullopt;
}

/// A symbol with its power: "m", "cm3", "s^-2", "m²".
std::optional<Unit> factor(std::string_view text, int sign) {
  int power = 1;
  const std::size_t end = text.find_first_of("^-0123456789");
  std::string_view name = text.substr(0, end);
  if (end != std::string_view::npos) {
    std::string_view digits = text.substr(end);
    if (digits.front() == '^') digits.remove_prefix(1);
    const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), power);
    if (error != std::errc() || rest != digits.data() + digits.size() || std::abs(power) > 9)
      return std::nullopt;
  } else if (name.ends_with("²") || name.ends_with("³")) {
    power = name.ends_with("²") ? 2 : 3;
    name.remove_suffix(std::string_view("²").size());
  }
  std::optional<Unit> unit = symbol(name);
  if (unit)
    *unit = {unit->kg * power * sign, unit->m * power * sign, unit->s * power * sign,
             unit->ten * power * sign};
  return unit;
}

/// Factors between blanks, of which those behind a slash divide: "kg/m3", "Pa s", "1/s"; "" is 1.
std::optional<Unit> unit_of(std::string_view text) {
  Unit unit;
  int sign = 1;
  if (text.starts_with("1/")) text.remove_prefix(1);
  while (!text.empty()) {
    if (text.front() == '/') {
      sign = -1;
      text.remove_prefix(1);
    }
    const std::size_t end = std::min(text.find_first_of(" /"), text.size());
    const auto next = factor(text.substr(0, end), sign);
    if (!next) return std::nullopt;
    unit = {unit.kg + next->kg, unit.m + next->m, unit.s + next->s, unit.ten + next->ten};
    sign = 1;
    text.remove_prefix(end);
    while (text.starts_with(' ')) text.remove_prefix(1);
  }
  return unit;
}

}  // namespace

ConvertedNumber converted(const std::string& text, const std::string& wanted) {
  double value = 0.0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error == std::errc::invalid_argument || end == last) return {};
  const std::string_view number(text.data(), static_cast<std::size_t>(end - text.data()));
  std::string_view name(end, static_cast<std::size_t>(last - end));
  while (name.starts_with(' ')) name.remove_prefix(1);
  const std::string shown_name = '"' + printable(std::string(name)) + '"';
  const std::optional<Unit> unit = unit_of(name);
  if (!unit || name.empty())
    return {{},
            shown_name +
                " is no unit; there are kg, g, t, m, s, Hz, N, Pa, J, with G, M, k, c, m, µ before them"};
  const Unit own = unit_of(wanted).value_or(Unit{});
  if (!unit->same_dimension(own))
    return {
        {},
        shown_name + " is no unit of " + (wanted.empty() ? "a number without one" : "what is in " + wanted)};
  const std::size_t e = std::min(number.find_first_of("eE"), number.size());
  std::int32_t exponent = 0;
  auto fault = std::errc();
  if (e != number.size()) {
    const std::size_t digits = e + (number[e + 1] == '+' ? 2 : 1);
    fault = std::from_chars(number.data() + digits, end, exponent).ec;
  }
  const std::string shifted =
      std::string(number.substr(0, e)) + 'e' + std::to_string(std::int64_t{exponent} + unit->ten - own.ten);
  if (fault == std::errc())
    fault = std::from_chars(shifted.data(), shifted.data() + shifted.size(), value).ec;
  if (fault != std::errc() || std::fpclassify(value) == FP_SUBNORMAL)
    return {{}, "it is too small or too large for a number"};
  return {value};
}

}  // namespace hompm::detail
