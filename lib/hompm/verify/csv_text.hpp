// What both readers of CSV files do with a line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hompm::detail {

/// Where the comma-separated fields of `text` end.
void split_at_commas(std::string_view text, std::vector<std::size_t>& ends);

/// Field `column` of a line that was split so.
inline std::string_view field_of(std::string_view text, const std::vector<std::size_t>& ends,
                                 std::size_t column) {
  const std::size_t begin = column == 0 ? 0 : ends[column - 1] + 1;
  return text.substr(begin, ends[column] - begin);
}

/// The number in `text`. NaN when it is not a finite one; `fault_kind` and `fault` then say what it is, in
/// the words of `MessageLog`: "values that are not numbers", "is not a number".
double finite_number(std::string_view text, std::string& fault_kind, std::string& fault);

/// What is wrong with a header that holds no comma, or "".
std::string other_separator(std::string_view header);

}  // namespace hompm::detail
