#include <algorithm>
#include <cmath>
#include <utility>

#include <hompm/kit/verify/table_comparison.hpp>
#include <hompm/number.hpp>

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

namespace {

/// The row at hand, the one after it and the key of the one before.
class Cursor {
 public:
  explicit Cursor(Table& table) : table_(table), has_row_(table.next(row_)) {
    has_following_ = has_row_ && table.next(following_);
  }

  [[nodiscard]] bool has_row() const { return has_row_; }
  [[nodiscard]] const Row& row() const { return row_; }
  [[nodiscard]] const RowKey& key() const { return row_.key; }
  /// Where a row that should come now would stand.
  [[nodiscard]] std::int64_t line() const { return has_row_ ? row_.line : table_.next_line(); }
  [[nodiscard]] Table& table() const { return table_; }

  [[nodiscard]] bool is_followed_by(const RowKey& key) const {
    return has_following_ && following_.key == key;
  }
  /// Whether what comes next is the same row in both tables, or the end.
  [[nodiscard]] bool is_followed_like(const Cursor& other) const {
    return has_following_ ? other.is_followed_by(following_.key) : !other.has_following_;
  }
  /// Whether the row at hand was there before.
  [[nodiscard]] bool is_repeated() const { return has_before_ && row_.key == before_; }
  /// Whether the row at hand should have come earlier.
  [[nodiscard]] bool is_late() const { return has_before_ && row_.key < before_; }

  /// Goes on from a row that stands where it should.
  void advance() {
    before_ = row_.key;
    has_before_ = true;
    skip();
  }
  /// Goes on from a row that says nothing about where the others should stand.
  void skip() {
    std::swap(row_, following_);
    has_row_ = has_following_;
    has_following_ = has_row_ && table_.next(following_);
  }

 private:
  Table& table_;
  Row row_;
  Row following_;
  RowKey before_;
  bool has_row_;
  bool has_following_;
  bool has_before_ = false;
};

std::string describe(const RowKey& key) {
  return "time " + to_text(key.time) + (key.particle < 0 ? "" : ", particle " + std::to_string(key.particle));
}

/// `expected` is null where the other table has ended.
void report_order(const Cursor& side, const RowKey* expected) {
  const auto& found = side.key();
  std::string text = "row order differs: ";
  if (expected == nullptr)
    text += describe(found) + " comes too late";
  else if (found.time == expected->time && found.particle != expected->particle)
    text += "particle " + std::to_string(found.particle) + " where " + std::to_string(expected->particle) +
            " is expected";
  else
    text += describe(found) + " where " + describe(*expected) + " is expected";
  side.table().fault("rows out of order", side.line(), text);
}

class Walk {
 public:
  Walk(Table& a, Table& b, std::size_t fields, FieldJudge& judge)
      : a_(a), b_(b), judge_(judge), values_b_(fields) {}

  void run(bool more_times) {
    measure_b();
    while (a_.has_row() && b_.has_row()) {
      if (more_times && a_.key().time < b_.key().time) {
        a_.advance();
      } else if (a_.key() == b_.key()) {
        compare_rows();
        a_.advance();
        pass_b(&Cursor::advance);
      } else {
        resolve_mismatch();
      }
    }
    while (a_.has_row()) drop_a();
    while (b_.has_row()) drop_b();
    judge_.end_time();
  }

 private:
  /// Says what is wrong with two rows that do not belong together, and goes to where they may again: one row
  /// out of place must not make all that follow look out of place.
  void resolve_mismatch() {
    if (a_.is_followed_by(b_.key()) && b_.is_followed_by(a_.key())) {  // two rows are swapped
      const bool a_is_right = a_.key() < b_.key();
      report_order(a_is_right ? b_ : a_, a_is_right ? &a_.key() : &b_.key());
      for (int row = 0; row < 2; ++row) {
        a_.advance();
        pass_b(&Cursor::advance);
      }
    } else if (a_.is_followed_like(b_)) {  // one row in place of another
      report_order(a_, &b_.key());
      a_.skip();
      pass_b(&Cursor::skip);
    } else {
      const bool a_has_more =
          a_.is_followed_by(b_.key()) || (!b_.is_followed_by(a_.key()) && a_.key() < b_.key());
      if (a_has_more)
        drop_a();
      else
        drop_b();
    }
  }

  /// Passes over a row of the first table that the second one does not have here.
  void drop_a() {
    if (report_misplaced(a_, b_)) return a_.skip();
    a_.table().fault("extra rows", a_.line(), "extra row: " + describe(a_.key()));
    a_.advance();
  }

  /// Passes over a row of the second table that the first one does not have here.
  void drop_b() {
    if (report_misplaced(b_, a_)) return pass_b(&Cursor::skip);
    a_.table().fault("missing rows", a_.line(), "the row of " + describe(b_.key()) + " is missing");
    pass_b(&Cursor::advance);
  }

  /// Whether the row at hand of `side` should not be where it is in its own table; if so, says it.
  static bool report_misplaced(const Cursor& side, const Cursor& other) {
    if (side.is_repeated()) {
      side.table().fault("repeated rows", side.line(),
                         "the row of " + describe(side.key()) + " is there twice");
      return true;
    }
    if (!side.is_late() && !(other.has_row() && other.key() < side.key())) return false;
    report_order(side, other.has_row() ? &other.key() : nullptr);
    return true;
  }

  /// Goes on in the second table, by `Cursor::advance` or `Cursor::skip`.
  void pass_b(void (Cursor::*go_on)()) {
    const double time = b_.key().time;
    (b_.*go_on)();
    if (b_.has_row() && b_.key().time != time) judge_.end_time();
    measure_b();
  }

  void measure_b() {
    if (!b_.has_row()) return;
    for (std::size_t field = 0; field < values_b_.size(); ++field) {
      if (!b_.table().has(field)) continue;
      values_b_[field] = b_.table().value(b_.row(), field);
      if (!std::isnan(values_b_[field])) judge_.measure(field, values_b_[field]);
    }
  }

  void compare_rows() {
    for (std::size_t field = 0; field < values_b_.size(); ++field) {
      if (!a_.table().has(field) || !b_.table().has(field)) continue;
      const double b = values_b_[field];
      // Mostly the text is the same, and reading numbers is what takes the time.
      const bool same_text = a_.table().text(a_.row(), field) == b_.table().text(b_.row(), field);
      const double a = same_text && !std::isnan(b) ? b : a_.table().value(a_.row(), field);
      if (std::isnan(a) || std::isnan(b)) continue;
      if (a == 0.0 && b == 0.0 && std::signbit(a) != std::signbit(b)) {
        a_.table().note("zeros of another sign", a_.line(),
                        to_text(a) + " where line " + std::to_string(b_.line()) + " of the other file has " +
                            to_text(b) + " (" + describe(a_.key()) + ")");
      }
      judge_.compare(field, a, b, a_.key().time, a_.key().particle);
    }
  }

  Cursor a_;
  Cursor b_;
  FieldJudge& judge_;
  std::vector<double> values_b_;  // of the row at hand
};

}  // namespace

void compare_tables(Table& a, Table& b, std::size_t fields, FieldJudge& judge, bool more_times) {
  Walk(a, b, fields, judge).run(more_times);
}

}  // namespace hompm::detail
