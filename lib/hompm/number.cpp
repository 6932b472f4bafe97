#include <array>
#include <charconv>
#include <cmath>

#include <hompm/error.hpp>
#include <hompm/number.hpp>

namespace hompm {

void append_text(std::string& out, double value) {
  if (!std::isfinite(value)) throw Error("a value that is not finite cannot be written");
  std::array<char, 32> buffer{};  // the shortest form of any double has at most 24 characters
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  out.append(buffer.data(), end);
}

std::string to_text(double value) {
  std::string text;
  append_text(text, value);
  return text;
}

}  // namespace hompm
