#include <array>
#include <cmath>
#include <type_traits>

#include <hompm/number.hpp>
#include <hompm/scene_file/content.hpp>

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
  for (const char character : shortened(text, longest)) {
    out += is_control(character) ? unicode_escape(character) : std::string(1, character);
  }
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

}  // namespace hompm::detail
