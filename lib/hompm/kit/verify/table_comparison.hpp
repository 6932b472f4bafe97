// Two tables of results against each other, row by row, and the verdict on their fields.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <hompm/kit/verify/table.hpp>

namespace hompm::detail {

class FieldJudge {
 public:
  /// `tolerances[i]` belongs to `fields[i]`; `file` is what results are labelled with.
  FieldJudge(const std::string& file, std::span<const std::string> fields, std::vector<Tolerance> tolerances);

  /// A value of the second folder at the current time: what a relative tolerance is relative to.
  void measure(std::size_t field, double b);
  /// A pair of values at the current time. Both must be finite.
  void compare(std::size_t field, double a, double b, double time, std::int64_t particle);
  /// Ends the current time: only now the largest magnitude of each field is known.
  void end_time();

  [[nodiscard]] const std::vector<FieldComparison>& fields() const { return fields_; }
  [[nodiscard]] const std::optional<Difference>& first() const { return first_; }
  [[nodiscard]] const std::optional<Difference>& first_beyond() const { return first_beyond_; }

 private:
  struct Pending {
    std::size_t field;
    double time;
    std::int64_t particle;
    double a;
    double b;
  };
  [[nodiscard]] Difference full(const Pending& difference) const;

  std::vector<FieldComparison> fields_;
  std::vector<Tolerance> tolerances_;
  std::vector<double> largest_;   // magnitude of each field at the current time
  std::vector<Pending> pending_;  // differences of the current time that no absolute or ulp bound covers
  bool any_relative_ = false;
  std::optional<Difference> first_;
  std::optional<Difference> first_beyond_;
};

/// Hands every pair of values with the same time and particle to `judge`; rows without a counterpart or in
/// another order become messages. `fields` counts the fields of the tables. With `more_times`, A may have
/// rows at times between those of B. Throws `FileError`.
void compare_tables(Table& a, Table& b, std::size_t fields, FieldJudge& judge, bool more_times = false);

}  // namespace hompm::detail
