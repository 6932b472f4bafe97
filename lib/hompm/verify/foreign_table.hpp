// Particle results as other codes write them: one CSV file, columns by name, any order of columns and rows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hompm/verify/line_reader.hpp>
#include <hompm/verify/message_log.hpp>

namespace hompm::detail {

/// Particles at one time, in order of X.
struct ParticleBlock {
  double time = 0.0;                        ///< s
  std::vector<double> X;                    ///< m, ascending, no two equal
  std::vector<std::vector<double>> values;  ///< by field, one entry per particle; NaN where unreadable
};

/// More lenient than `CsvTable`, which takes only what this project writes: blanks around fields, quotes
/// around names, a `#` or byte order mark before the header and columns nobody asks for are let pass.
class ForeignTable {
 public:
  /// Opens `path`, finds `X`, `time` and those of `fields` that are there, and collects the times. Where
  /// `only_time` is set a file without `time` is all at that time. What is wrong goes to `faults`, what is
  /// worth knowing to `notes`. Throws `FileError` when the file cannot be read.
  ForeignTable(std::filesystem::path path, std::span<const std::string> fields,
               std::optional<double> only_time, MessageLog& faults, MessageLog& notes);

  /// False when columns are missing that nothing can be compared without.
  [[nodiscard]] bool is_usable() const { return usable_; }
  /// Distinct times in the file, ascending, s.
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  /// Those of the wanted fields that the file has, in the order in which they were asked for.
  [[nodiscard]] const std::vector<std::string>& fields() const { return fields_; }

  /// The particles at `times`, which must be ascending and among `times()`. Memory goes by the rows at these
  /// times, not by the file. Throws `FileError`.
  std::vector<ParticleBlock> read(std::span<const double> times);

  /// Adds a message about the file as a whole; see `MessageLog`.
  void fault(const std::string& kind, const std::string& text) { faults_.add(name_, kind, 0, text); }
  void note(const std::string& text) { notes_.add(name_, text, 0, text); }

 private:
  /// The next row with as many fields as the header; others are reported if `report`. False at the end.
  bool next(LineReader& reader, bool report);
  [[nodiscard]] std::string_view field(std::size_t column) const;
  void read_header(LineReader& reader, std::span<const std::string> wanted);
  void find_columns(std::span<const std::string> wanted);
  void collect_times(LineReader& reader);
  /// NaN, after a message if `report`, when the field is not a finite number.
  double number(const LineReader& reader, std::size_t column, bool report);
  void sort(ParticleBlock& block);

  std::filesystem::path path_;
  std::string name_;
  std::optional<double> only_time_;
  MessageLog& faults_;
  MessageLog& notes_;
  bool usable_ = false;
  std::vector<std::string> header_;
  std::vector<std::string> fields_;
  std::vector<std::size_t> columns_;  // of fields_
  std::size_t X_column_ = 0;
  std::optional<std::size_t> time_column_;
  std::vector<double> times_;
  std::string_view row_;           // at hand
  std::vector<std::size_t> ends_;  // of its fields
};

}  // namespace hompm::detail
