#include "text_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace hompm::cli {

std::string text_table(const std::vector<std::vector<std::string>>& rows, std::size_t names) {
  std::vector<std::size_t> width(rows.empty() ? 0 : rows.front().size());
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(width[i] - row[i].size(), ' ');
      line += (i == 0 ? "" : "  ") + (i < names ? row[i] + padding : padding + row[i]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string rounded(double value) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 32> buffer{};
  char* const begin = buffer.data();
  const auto end = std::to_chars(begin, begin + buffer.size(), value, std::chars_format::general, 3).ptr;
  return {begin, end};
}

}  // namespace hompm::cli
