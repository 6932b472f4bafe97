#include <algorithm>
#include <bit>
#include <cmath>

#include <hompm/verify/field_judge.hpp>

namespace hompm::detail {

FieldJudge::FieldJudge(const std::string& file, std::span<const std::string> fields,
                       std::vector<Tolerance> tolerances)
    : fields_(fields.size()), tolerances_(std::move(tolerances)), largest_(fields.size(), 0.0) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    fields_[i].file = file;
    fields_[i].field = fields[i];
  }
  any_relative_ =
      std::any_of(tolerances_.begin(), tolerances_.end(), [](const auto& t) { return t.relative > 0.0; });
}

void FieldJudge::measure(std::size_t field, double b) {
  largest_[field] = std::max(largest_[field], std::abs(b));
}

void FieldJudge::compare(std::size_t field, double a, double b, double time, std::int64_t particle) {
  auto& result = fields_[field];
  ++result.values;
  if (std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b)) return;

  const Pending difference{field, time, particle, a, b};
  const double distance = std::abs(a - b);
  if (result.differing++ == 0 || distance > result.largest_absolute) {
    result.largest_absolute = distance;
    result.worst = full(difference);
  }
  if (!first_) first_ = full(difference);

  const auto& tolerance = tolerances_[field];
  if (tolerance.absolute > 0.0 && distance <= tolerance.absolute) return;
  if (ulp_distance(a, b) <= tolerance.ulps) return;
  pending_.push_back(difference);
  if (!any_relative_) end_time();  // nothing to wait for, so nothing to keep in memory
}

void FieldJudge::end_time() {
  for (const auto& difference : pending_) {
    const double relative = tolerances_[difference.field].relative;
    if (relative > 0.0 && std::abs(difference.a - difference.b) <= relative * largest_[difference.field])
      continue;
    ++fields_[difference.field].beyond;
    if (!first_beyond_) first_beyond_ = full(difference);
  }
  pending_.clear();
  if (any_relative_) std::fill(largest_.begin(), largest_.end(), 0.0);
}

Difference FieldJudge::full(const Pending& difference) const {
  const auto& [field, time, particle, a, b] = difference;
  return {fields_[field].file, fields_[field].field, time, particle, a, b, ulp_distance(a, b)};
}

}  // namespace hompm::detail
