#include "comparison_text.hpp"

#include <sstream>
#include <vector>

#include <hompm/number.hpp>

#include "text_table.hpp"

namespace hompm::cli {
namespace {

std::string place(const Difference& d) {
  return d.file + ", " + d.field + ", time " + to_text(d.time) +
         (d.particle < 0 ? "" : ", particle " + std::to_string(d.particle));
}

std::string distance(std::uint64_t ulps) { return std::to_string(ulps) + (ulps == 1 ? " ulp" : " ulps"); }

/// The fields that differ, or "" when none does.
std::string table(const std::vector<FieldComparison>& fields) {
  std::vector<std::vector<std::string>> rows{
      {"file", "field", "values", "differing", "beyond", "worst |A-B|", "ulps", "time", "particle"}};
  for (const auto& f : fields) {
    if (f.differing == 0) continue;
    rows.push_back({f.file, f.field, std::to_string(f.values), std::to_string(f.differing),
                    std::to_string(f.beyond), to_text(f.largest_absolute), std::to_string(f.worst.ulps),
                    to_text(f.worst.time), f.worst.particle < 0 ? "-" : std::to_string(f.worst.particle)});
  }
  return rows.size() > 1 ? text_table(rows, 2) : "";
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
  out << table(comparison.fields);
  for (const auto& note : comparison.notes) out << "note: " << note << '\n';
  return out.str();
}

}  // namespace hompm::cli
