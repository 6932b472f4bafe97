// A results table, read row by row, with a message for everything that is not as this project writes it.
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hompm/verify/csv_text.hpp>
#include <hompm/verify/line_reader.hpp>
#include <hompm/verify/message_log.hpp>
#include <hompm/verify/ordered_bits.hpp>

namespace hompm::detail {

/// What a row belongs to, in the order in which rows follow each other.
struct RowKey {
  double time = 0.0;           ///< s
  std::int64_t particle = -1;  ///< −1 in a table without particles

  friend bool operator==(const RowKey& a, const RowKey& b) { return std::is_eq(a <=> b); }
  friend std::strong_ordering operator<=>(const RowKey& a, const RowKey& b) {
    const auto times = ordered_bits(a.time) <=> ordered_bits(b.time);
    return std::is_neq(times) ? times : a.particle <=> b.particle;
  }
};

/// One row as text, cut into fields.
struct CsvRow {
  std::int64_t line = 0;
  RowKey key;
  std::string text;
  std::vector<std::size_t> ends;  ///< of the fields in `text`

  [[nodiscard]] std::string_view field(std::size_t column) const { return field_of(text, ends, column); }
};

class CsvTable {
 public:
  /// Opens `path` and reads the header, which must hold `time`, `particle` (where `with_particles`) and
  /// `fields` in any order. What is missing or unknown goes to `faults`, what does not touch the data to
  /// `notes`. Throws `FileError` when the file cannot be read.
  CsvTable(const std::filesystem::path& path, std::span<const std::string> fields, bool with_particles,
           MessageLog& faults, MessageLog& notes);

  /// Whether rows can be told apart: false when the file is empty or has no column for the time or the
  /// particle.
  [[nodiscard]] bool has_keys() const { return has_keys_; }
  /// Whether the header has `fields[field]`.
  [[nodiscard]] bool has(std::size_t field) const { return columns_[field].has_value(); }

  /// Reads the next row that has the right number of fields and a readable key; all others are reported and
  /// passed over. False at the end. Throws `FileError`.
  bool next(CsvRow& row);
  /// Text of `fields[field]`, which must be there.
  [[nodiscard]] std::string_view text(const CsvRow& row, std::size_t field) const {
    return row.field(*columns_[field]);
  }
  /// Number in `fields[field]`; NaN after a message when it is not a finite number.
  double value(const CsvRow& row, std::size_t field);

  /// Adds a message about `line` of this file; see `MessageLog`.
  void fault(const std::string& kind, std::int64_t line, const std::string& text);
  void note(const std::string& kind, std::int64_t line, const std::string& text);
  /// Line after the last one read.
  [[nodiscard]] std::int64_t next_line() const { return reader_.number() + 1; }

 private:
  void read_header(std::span<const std::string> fields, bool with_particles);
  bool read_key(CsvRow& row);
  double number(std::string_view text, const std::string& column, std::int64_t line);

  std::string name_;
  LineReader reader_;
  MessageLog& faults_;
  MessageLog& notes_;
  std::vector<std::string> header_;
  std::vector<std::optional<std::size_t>> columns_;  // where each field stands
  std::size_t time_column_ = 0;
  std::optional<std::size_t> particle_column_;
  bool has_keys_ = false;
  std::string time_text_;  // of the row before: particles of one snapshot share it
  double time_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace hompm::detail
