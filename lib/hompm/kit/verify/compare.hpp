// Exact comparison of two run or golden folders.
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hompm::detail {

/// The first line in which two texts differ, of each; "nothing more" where one has ended.
std::pair<std::string, std::string> first_different_lines(const std::string& a, const std::string& b);

/// The next double up is the next integer up; −0 comes right before +0.
inline std::uint64_t ordered_bits(double value) {
  constexpr std::uint64_t sign = std::uint64_t{1} << 63;
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return (bits & sign) != 0 ? ~bits : bits | sign;
}

}  // namespace hompm::detail

namespace hompm {

/// `identical`: the same rows and every value bit-equal. `equivalent`: the same rows and every value that is
/// not bit-equal within the tolerance asked for its field. `different`: everything else; without a tolerance
/// one bit is enough, and no tolerance excuses what `Comparison::messages` tells.
enum class Verdict { identical, equivalent, different };

/// "identical", "equivalent" or "different".
std::string to_string(Verdict verdict);

/// What is still called equivalent for one field. A value passes when it meets any of the bounds that are set
/// (> 0). `absolute` bounds |a − b| in the unit of the field, `relative` bounds |a − b| over the largest
/// magnitude of the field at that time in the second folder, `ulps` bounds `ulp_distance(a, b)`.
struct Tolerance {
  double absolute = 0.0;
  double relative = 0.0;
  std::uint64_t ulps = 0;
};

/// The place where two values of one field differ.
struct Difference {
  std::string file;            ///< "particles.csv"
  std::string field;           ///< column
  double time = 0.0;           ///< s
  std::int64_t particle = -1;  ///< −1 for history.csv
  double a = 0.0;
  double b = 0.0;
  std::uint64_t ulps = 0;
};

/// Worst difference of one field of one file, and how many values differ at all.
struct FieldComparison {
  std::string file;
  std::string field;
  std::uint64_t values = 0;       ///< pairs compared
  std::uint64_t differing = 0;    ///< not bit-equal
  std::uint64_t beyond = 0;       ///< not bit-equal and beyond the tolerance
  double largest_absolute = 0.0;  ///< largest |a − b|, in the unit of the field
  Difference worst;               ///< where that is; meaningful when differing > 0
};

struct Comparison {
  Verdict verdict = Verdict::identical;
  /// Missing, extra, reordered, cut or unreadable data, NaN and infinity: one line each, with file and line.
  /// Any of them makes the verdict `different`. Of many of one kind the first three are told and the rest
  /// counted.
  std::vector<std::string> messages;
  /// Worth knowing, but nothing the verdict hangs on: CRLF line ends, another order of columns, −0 against 0
  /// (which counts as a difference of 1 ulp in `fields`).
  std::vector<std::string> notes;
  std::vector<FieldComparison> fields;  ///< in the order of files and columns
  /// The first difference in file, time, particle and column order that is beyond its tolerance; without such
  /// a one, the first that is not bit-equal.
  std::optional<Difference> first;
};

/// The fields that are compared and can have a tolerance: the columns of the three files but `time` and
/// `particle`.
const std::vector<std::string>& compared_fields();

/// Compares particles.csv, stress.csv and history.csv of two folders (`b` is the golden one), columns matched
/// by name and rows by time and particle, both in order. A file only one folder has is a difference.
/// `tolerances` goes by field and holds in every file that has the field. Files are read row by row, so their
/// size does not matter. With `more_times`, `a` may hold times between those of `b`. Throws `FileError` when
/// a folder or file cannot be read or one of the folders holds no results, `Error` for a tolerance of an
/// unknown field.
Comparison compare_folders(const std::filesystem::path& a, const std::filesystem::path& b,
                           const std::map<std::string, Tolerance>& tolerances, bool more_times = false);

/// Adds to `comparison` whether scene.toml is the same text, line ends aside, where both folders have one: a
/// difference is a message and makes the verdict `different`. Throws `FileError`.
void compare_scenes(const std::filesystem::path& a, const std::filesystem::path& b, Comparison& comparison);

/// Distance in units in the last place; 0 for equal bits, 1 for +0 against −0; the largest value when either
/// is NaN.
std::uint64_t ulp_distance(double a, double b);

}  // namespace hompm
