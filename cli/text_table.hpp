// Columns of text under each other.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hompm::cli {

/// One line per row, the columns two blanks apart; the first `names` columns are flush left, the others flush
/// right. All rows must be as long as the first.
std::string text_table(const std::vector<std::vector<std::string>>& rows, std::size_t names);

/// `text`, filled up with blanks to `width` columns; at least one, unless it is empty and `width` is 0.
std::string padded(std::string text, std::size_t width);

/// The words of `text` in lines of at most 80 columns: `head` before those of the first line, all words from
/// the column `indent` on, or behind a longer head.
std::string wrapped(const std::string& head, std::size_t indent, const std::string& text);

/// Three digits, in every locale; "-" for what is not finite.
std::string rounded(double value);

}  // namespace hompm::cli
