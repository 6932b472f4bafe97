#include "text_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

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

namespace {

/// Columns that UTF-8 takes on a terminal: its bytes that continue no character.
std::size_t columns(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

std::string padded(std::string text, std::size_t width) {
  const std::size_t now = columns(text);
  if (now >= width) return text + (text.empty() ? "" : " ");
  return text.append(width - now, ' ');
}

std::string wrapped(const std::string& head, std::size_t indent, const std::string& text) {
  std::string all;
  std::string line = padded(head, indent);
  std::istringstream words(text);
  const char* blank = "";
  for (std::string word; words >> word; blank = " ") {
    if (*blank != '\0' && columns(line) + 1 + columns(word) > 80) {
      all += line + "\n";
      line.assign(indent, ' ');
      blank = "";
    }
    line += blank + word;
  }
  return all + line + "\n";
}

std::string rounded(double value) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 32> buffer{};
  char* const begin = buffer.data();
  const auto end = std::to_chars(begin, begin + buffer.size(), value, std::chars_format::general, 3).ptr;
  return {begin, end};
}

}  // namespace hompm::cli
