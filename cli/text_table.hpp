// Columns of text under each other.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hompm::cli {

/// One line per row, the columns two blanks apart; the first `names` columns are flush left, the others flush
/// right. All rows must be as long as the first.
std::string text_table(const std::vector<std::vector<std::string>>& rows, std::size_t names);

/// Three digits, in every locale; "-" for what is not finite.
std::string rounded(double value);

}  // namespace hompm::cli
