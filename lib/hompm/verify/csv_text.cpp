#include <charconv>
#include <cmath>
#include <limits>

#include <hompm/verify/csv_text.hpp>

namespace hompm::detail {

void split_at_commas(std::string_view text, std::vector<std::size_t>& ends) {
  ends.clear();
  for (auto comma = text.find(','); comma != text.npos; comma = text.find(',', comma + 1))
    ends.push_back(comma);
  ends.push_back(text.size());
}

double finite_number(std::string_view text, std::string& fault_kind, std::string& fault) {
  double value = 0.0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error == std::errc{} && end == last && std::isfinite(value)) return value;
  if (end != last || error == std::errc::invalid_argument) {
    fault_kind = "values that are not numbers";
    fault = "is not a number";
  } else if (error == std::errc::result_out_of_range) {
    fault_kind = "values out of range";
    fault = "is beyond the range of a double";
  } else {
    fault_kind = "values that are not finite";
    fault = "is not finite";
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::string other_separator(std::string_view header) {
  if (header.find(',') != header.npos) return "";
  for (const auto& [separator, name] :
       {std::pair(';', "semicolons"), std::pair('\t', "tabs"), std::pair(' ', "blanks")}) {
    if (header.find(separator) == header.npos) continue;
    return std::string("the columns are separated by ") + name +
           ": commas between columns and points in numbers are needed";
  }
  return "";
}

}  // namespace hompm::detail
