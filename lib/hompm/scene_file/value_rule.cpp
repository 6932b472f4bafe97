#include <algorithm>
#include <cmath>

#include <hompm/number.hpp>
#include <hompm/scene_file/value_rule.hpp>

namespace hompm::detail {
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
  switch (type) {
    case ValueType::number:
      return "number";
    case ValueType::integer:
      return "integer";
    case ValueType::boolean:
      return "boolean";
    case ValueType::word:
      return "word";
    case ValueType::text:
      break;
  }
  return "text";
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
  switch (rule.type) {
    case ValueType::number: {
      const auto* whole = std::get_if<std::int64_t>(&content);
      const auto* real = std::get_if<double>(&content);
      if (whole == nullptr && real == nullptr) break;
      const double value = whole != nullptr ? static_cast<double>(*whole) : *real;
      if (in_range(rule, value)) return value;
      break;
    }
    case ValueType::integer:
      if (const auto* whole = std::get_if<std::int64_t>(&content)) {
        if (in_range(rule, static_cast<double>(*whole))) return content;
      }
      break;
    case ValueType::boolean:
      if (std::holds_alternative<bool>(content)) return content;
      break;
    case ValueType::word:
      if (const auto* word = std::get_if<std::string>(&content)) {
        if (std::find(rule.words.begin(), rule.words.end(), *word) != rule.words.end()) return content;
      }
      break;
    case ValueType::text:
      if (std::holds_alternative<std::string>(content)) return content;
      break;
  }
  return std::nullopt;
}

std::string listed(const std::vector<std::string>& words) {
  constexpr std::size_t most = 15;  // a message is one line that one reads
  const std::size_t shown = words.size() > most ? most - 3 : words.size();
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) text += (i == 0 ? "" : ", ") + words[i];
  return shown == words.size() ? text : text + " and " + std::to_string(words.size() - shown) + " more";
}

}  // namespace hompm::detail
