#include "comparison_text.hpp"

#include <algorithm>
#include <array>
#include <iomanip>
#include <sstream>
#include <vector>

#include <hompm/number.hpp>

namespace hompm::cli {
namespace {

std::string place(const Difference& d) {
  return d.file + ", " + d.field + ", time " + to_text(d.time) +
         (d.particle < 0 ? "" : ", particle " + std::to_string(d.particle));
}

std::string distance(std::uint64_t ulps) { return std::to_string(ulps) + (ulps == 1 ? " ulp" : " ulps"); }

void print_table(std::ostream& out, const std::vector<FieldComparison>& fields) {
  using Row = std::array<std::string, 9>;
  std::vector<Row> rows{
      {"file", "field", "values", "differing", "beyond", "worst |A-B|", "ulps", "time", "particle"}};
  for (const auto& f : fields) {
    if (f.differing == 0) continue;
    rows.push_back({f.file, f.field, std::to_string(f.values), std::to_string(f.differing),
                    std::to_string(f.beyond), to_text(f.largest_absolute), std::to_string(f.worst.ulps),
                    to_text(f.worst.time), f.worst.particle < 0 ? "-" : std::to_string(f.worst.particle)});
  }
  if (rows.size() == 1) return;
  std::array<int, 9> width{};
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i)
      width[i] = std::max(width[i], static_cast<int>(row[i].size()));
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool is_name = i < 2;
      out << (i == 0 ? "" : "  ") << (is_name ? std::left : std::right) << std::setw(width[i]) << row[i];
    }
    out << '\n';
  }
}

}  // namespace

std::string comparison_text(const Comparison& comparison) {
  std::ostringstream out;
  out << to_string(comparison.verdict) << '\n';
  if (comparison.first) {
    const auto& d = *comparison.first;
    out << "first difference: " << place(d) << ": " << to_text(d.a) << " in A, " << to_text(d.b) << " in B, "
        << distance(d.ulps) << '\n';
  }
  for (const auto& message : comparison.messages) out << message << '\n';
  print_table(out, comparison.fields);
  for (const auto& note : comparison.notes) out << "note: " << note << '\n';
  return out.str();
}

}  // namespace hompm::cli
