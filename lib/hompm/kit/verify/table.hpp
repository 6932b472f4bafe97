// A table of results as text, read row by row: ours to the letter, or anybody's; and what is said about it.
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hompm/kit/verify/compare.hpp>

namespace hompm::detail {

/// The lines of a text file of any size, one at a time.
class LineReader {
 public:
  /// Throws `FileError` when `path` cannot be opened or is not a regular file: a pipe could make the reader
  /// wait for ever.
  explicit LineReader(std::filesystem::path path);

  /// Goes to the next line; false at the end of the file. Throws `FileError` when the file cannot be read on,
  /// or when a line is so long that this is not a text file of ours.
  bool next();
  /// Goes back to before the first line. Throws `FileError`.
  void rewind();

  /// The line without its end, LF or CRLF; valid until `next`.
  [[nodiscard]] std::string_view line() const { return line_; }
  /// Number of the line, from 1.
  [[nodiscard]] std::int64_t number() const { return number_; }
  /// Whether the line ended in LF; only the last one may not.
  [[nodiscard]] bool has_end() const { return has_end_; }
  /// Whether the line ended in CRLF.
  [[nodiscard]] bool has_carriage_return() const { return has_carriage_return_; }

 private:
  static constexpr std::size_t longest_line = 1 << 16;
  std::filesystem::path path_;
  std::ifstream file_;
  std::vector<char> buffer_ = std::vector<char>(longest_line + 2);  // with what ends it
  std::string_view line_;
  std::int64_t number_ = 0;
  bool has_end_ = true;
  bool has_carriage_return_ = false;
};

/// The beginning of `text` in back quotes, printable whatever it holds.
inline std::string excerpt(std::string_view text) {
  constexpr std::size_t longest = 60;
  constexpr char digits[] = "0123456789abcdef";
  std::string shown = "`";
  for (const char c : text.substr(0, longest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f) {
      shown += c;
    } else {
      shown += {'\\', 'x', digits[byte / 16], digits[byte % 16]};
    }
  }
  return shown + (text.size() > longest ? "`…" : "`");
}

/// Messages about files: of each kind the first few, and a count of the rest.
class MessageLog {
 public:
  /// Keeps "<file> line <line>: <text>" for the first few of a kind in one file and counts the rest. `kind`
  /// is a plural: "missing rows". Line 0 stands for the file as a whole.
  void add(const std::string& file, const std::string& kind, std::int64_t line, const std::string& text) {
    if (counts_[{file, kind}]++ >= shown_of_a_kind) return;
    messages_.push_back(file + (line > 0 ? " line " + std::to_string(line) : "") + ": " + text);
  }

  /// All messages in the order in which they came, then what was only counted.
  [[nodiscard]] std::vector<std::string> messages() const {
    auto all = messages_;
    for (const auto& [what, count] : counts_) {
      if (count <= shown_of_a_kind) continue;
      all.push_back(what.first + ": " + what.second + ": " + std::to_string(count - shown_of_a_kind) +
                    " more");
    }
    return all;
  }

 private:
  static constexpr std::int64_t shown_of_a_kind = 3;
  std::vector<std::string> messages_;
  std::map<std::pair<std::string, std::string>, std::int64_t> counts_;
};

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
struct Row {
  std::int64_t line = 0;
  RowKey key;
  std::string text;
  std::vector<std::size_t> ends;  ///< of the fields in `text`, which a comma separates

  [[nodiscard]] std::string_view field(std::size_t column) const {
    const std::size_t begin = column == 0 ? 0 : ends[column - 1] + 1;
    return std::string_view(text).substr(begin, ends[column] - begin);
  }
};

/// What is looked for in a table.
struct TableLayout {
  std::vector<std::string> fields = {};
  bool with_particles = false;  ///< rows go by particle, too; of our tables only
  /// Anybody's: commas, semicolons (with decimal commas), tabs or blanks between columns; names by which
  /// others call the fields, in any case, with units; `#`, quotes, a byte order mark; columns nobody asks
  /// for.
  bool lenient = false;
  std::map<std::string, std::string> columns = {};  ///< by field the name, or number from 1, of its column
  char direction = 'x';                             ///< of the tables of 2D and 3D codes
  std::optional<double> only_time = {};             ///< s, of a lenient table without a column for the time
  std::string name = {};                            ///< of the file in messages, where it is not its path
};

class Table {
 public:
  /// Opens `path` and reads the header, which must hold `time` and `fields` in any order. What is missing or
  /// unknown goes to `faults`, what does not touch the data to `notes`. Throws `FileError` when the file
  /// cannot be read; in a lenient table also when it has no header or time.
  Table(const std::filesystem::path& path, TableLayout layout, MessageLog& faults, MessageLog& notes);

  /// Whether rows can be told apart: false when the file is empty or has no column for the time or the
  /// particle.
  [[nodiscard]] bool has_keys() const { return has_keys_; }
  /// Whether the header has `fields[field]`.
  [[nodiscard]] bool has(std::size_t field) const { return columns_[field].has_value(); }
  /// Columns of a lenient table that look like a field which is not there, with that field.
  [[nodiscard]] const std::vector<std::pair<std::string, std::string>>& lookalikes() const {
    return lookalikes_;
  }

  /// Reads the next row that has the right number of fields and a readable key; all others are reported and
  /// passed over. False at the end. Throws `FileError`.
  bool next(Row& row);
  /// Goes back to the first row; what was said of rows is not said again.
  void rewind();
  /// Text of `fields[field]`, which must be there.
  [[nodiscard]] std::string_view text(const Row& row, std::size_t field) const {
    return row.field(columns_[field]->index);
  }
  /// Number in `fields[field]`, in SI units; NaN after a message when it is not a finite number.
  double value(const Row& row, std::size_t field);

  /// Adds a message about `line` of this file; 0 stands for the file as a whole. See `MessageLog`.
  void fault(const std::string& kind, std::int64_t line, const std::string& text) {
    faults_.add(name_, kind, line, text);
  }
  void note(const std::string& kind, std::int64_t line, const std::string& text) {
    notes_.add(name_, kind, line, text);
  }
  /// Throws the `FileError` that says why this table cannot be read.
  [[noreturn]] void refuse(std::int64_t line, const std::string& text) const;
  /// Line after the last one read.
  [[nodiscard]] std::int64_t next_line() const { return reader_.number() + 1; }

 private:
  /// Where a field stands, and its unit: a value counts `times` / `over` SI units.
  struct Column {
    std::size_t index = 0;
    double times = 1.0;
    double over = 1.0;
  };

  void read_our_header();
  void read_any_header();
  void find_columns();
  [[nodiscard]] Column column_of(std::size_t index, std::string_view unit) const;
  bool cut(Row& row) const;
  bool read_key(Row& row);
  double number(const Row& row, const Column& column);

  TableLayout layout_;
  std::string name_;
  LineReader reader_;
  MessageLog& faults_;
  MessageLog& notes_;
  std::vector<std::string> header_;
  std::vector<std::optional<Column>> columns_;  // of the fields
  std::optional<Column> time_column_;
  std::optional<std::size_t> particle_column_;
  std::vector<std::pair<std::string, std::string>> lookalikes_;
  bool has_keys_ = false;
  char separator_ = ',';
  std::int64_t header_line_ = 0;
  bool at_row_ = false;     // the line at hand is the first row
  bool repeating_ = false;  // after `rewind`
  std::string time_text_;   // of the row before: particles of one snapshot share it
  double time_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace hompm::detail
