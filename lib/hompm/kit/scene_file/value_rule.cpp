#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>

#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/scene_file/units.hpp>
#include <hompm/kit/scene_file/value_rule.hpp>
#include <hompm/number.hpp>

namespace hompm::detail {
namespace {

bool is_control(char character) { return static_cast<unsigned char>(character) < 0x20 || character == 0x7f; }

std::string unicode_escape(char character) {
  constexpr std::array digits{'0', '1', '2', '3', '4', '5', '6', '7', '8', '9', 'A', 'B', 'C', 'D', 'E', 'F'};
  const auto code = static_cast<unsigned char>(character);
  return std::string("\\u00") + digits.at(code / 16U) + digits.at(code % 16U);
}

// Cuts between characters, not inside one of several bytes.
std::string shortened(const std::string& text, std::size_t longest) {
  if (text.size() <= longest) return text;
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + "…";
}

}  // namespace

std::string toml_number(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
  std::string text = to_text(value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string toml_string(const std::string& text) {
  std::string out = "\"";
  for (const char character : text) {
    if (is_control(character)) {
      out += unicode_escape(character);
    } else {
      if (character == '"' || character == '\\') out += '\\';
      out += character;
    }
  }
  return out + '"';
}

std::string printable(const std::string& text, std::size_t longest) {
  std::string out;
  for (const char character : shortened(text, longest))
    out += is_control(character) ? unicode_escape(character) : std::string(1, character);
  return out;
}

std::string shown(const Content& content) {
  return std::visit(
      [](const auto& value) -> std::string {
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<T, bool>) {
          return value ? "true" : "false";
        } else if constexpr (std::is_same_v<T, std::int64_t>) {
          return std::to_string(value);
        } else if constexpr (std::is_same_v<T, double>) {
          return toml_number(value);
        } else if constexpr (std::is_same_v<T, std::string>) {
          return '"' + printable(value) + '"';
        } else if constexpr (std::is_same_v<T, TomlTable>) {
          return "a table";
        } else if constexpr (std::is_same_v<T, Array>) {
          return "an array";
        } else {
          return "a date or time";
        }
      },
      content);
}

namespace {

std::string bound_text(double bound) {
  const bool whole = bound == std::floor(bound) && std::abs(bound) < 1e15;
  return whole ? std::to_string(static_cast<std::int64_t>(bound)) : to_text(bound);
}

bool in_range(const ValueRule& rule, double value) {
  const bool above = rule.minimum_excluded ? value > rule.minimum : value >= rule.minimum;
  return std::isfinite(value) && above && value <= rule.maximum;
}

}  // namespace

ValueRule rule_of(const EffectParameter& parameter) {
  return {parameter.words.empty() ? ValueType::number : ValueType::word,
          parameter.unit == "–" || parameter.unit == "-" ? "" : parameter.unit,
          parameter.minimum,
          parameter.maximum,
          parameter.minimum_excluded,
          parameter.words};
}

std::string toml_value(const EffectSpec::Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return toml_number(*number);
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  return toml_string(std::get<std::string>(value));
}

std::string type_name(ValueType type) {
  return std::array{"number", "integer", "boolean", "word", "text"}[static_cast<std::size_t>(type)];
}

std::string range_text(const ValueRule& rule) {
  if (rule.type == ValueType::boolean) return "true, false";
  if (rule.type == ValueType::word) return listed(rule.words);
  const bool below = std::isfinite(rule.minimum);
  const bool above = std::isfinite(rule.maximum);
  std::string least = below ? bound_text(rule.minimum) : "";
  if (!above) return below ? (rule.minimum_excluded ? "> " : "≥ ") + least : "";
  const std::string most = bound_text(rule.maximum);
  if (least == most) return least;
  if (!below) return "≤ " + most;
  return rule.minimum_excluded ? "> " + least + ", ≤ " + most : least + " … " + most;
}

std::string demand(const ValueRule& rule) {
  if (rule.type == ValueType::boolean) return "true or false";
  if (rule.type == ValueType::text) return "a text in quotes";
  if (rule.type == ValueType::word) return (rule.words.size() == 1 ? "" : "one of ") + listed(rule.words);
  const bool below = std::isfinite(rule.minimum);
  const bool above = std::isfinite(rule.maximum);
  const bool whole = rule.type == ValueType::integer;
  std::string text = whole ? "a whole number" : below || above ? "a number" : "a finite number";
  if (below && above && !rule.minimum_excluded) {
    text += " from " + bound_text(rule.minimum) + " to " + bound_text(rule.maximum);
  } else {
    if (below)
      text += (rule.minimum_excluded ? " greater than " : " of at least ") + bound_text(rule.minimum);
    if (above) text += (below ? " and at most " : " of at most ") + bound_text(rule.maximum);
  }
  return rule.unit.empty() ? text : text + " (" + rule.unit + ')';
}

std::optional<Content> accepted(const ValueRule& rule, const Content& content) {
  const auto* whole = std::get_if<std::int64_t>(&content);
  const auto* real = std::get_if<double>(&content);
  const auto* word = std::get_if<std::string>(&content);
  double value = whole != nullptr ? static_cast<double>(*whole) : real != nullptr ? *real : 0.0;
  switch (rule.type) {
    case ValueType::number: {
      bool is_number = whole != nullptr || real != nullptr;
      if (word != nullptr) {
        const auto with_unit = converted(*word, rule.unit).value;
        is_number = with_unit.has_value();
        value = with_unit.value_or(0.0);
      }
      return is_number && in_range(rule, value) ? std::optional<Content>(value) : std::nullopt;
    }
    case ValueType::integer:
      return whole != nullptr && in_range(rule, value) ? std::optional(content) : std::nullopt;
    case ValueType::boolean:
      return std::holds_alternative<bool>(content) ? std::optional(content) : std::nullopt;
    case ValueType::word:
      return word != nullptr && std::ranges::find(rule.words, *word) != rule.words.end()
                 ? std::optional(content)
                 : std::nullopt;
    default: return word != nullptr ? std::optional(content) : std::nullopt;
  }
}

std::string listed(const std::vector<std::string>& words) {
  constexpr std::size_t most = 15;  // a message is one line that one reads
  const std::size_t shown = words.size() > most ? most - 3 : words.size();
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) text += (i == 0 ? "" : ", ") + words[i];
  return shown == words.size() ? text : text + " and " + std::to_string(words.size() - shown) + " more";
}

}  // namespace hompm::detail

namespace hompm {
namespace {

std::string lower(std::string text) {
  for (char& character : text)
    character = static_cast<char>(std::tolower(static_cast<unsigned char>(character)));
  return text;
}

// Insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> current(b.size() + 1);
  std::iota(current.begin(), current.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last = std::exchange(last, current);
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({last[j] + 1, current[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        current[j] = std::min(current[j], before_last[j - 2] + 1);
      }
    }
  }
  return current[b.size()];
}

}  // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string wanted = lower(word);
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::string name = lower(candidate);
    // A name begun and not ended counts as one mistake.
    const bool begun = wanted.size() >= 3 && name.starts_with(wanted);
    // Lengths that differ by more than the best distance cannot give a better one.
    const std::size_t difference =
        wanted.size() > name.size() ? wanted.size() - name.size() : name.size() - wanted.size();
    if (!begun && difference >= best_distance) continue;
    const std::size_t distance = begun ? std::min<std::size_t>(1, difference) : edit_distance(wanted, name);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace hompm
