// Lines of a text file of any size, one at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

namespace hompm::detail {

class LineReader {
 public:
  /// Throws `FileError` when `path` cannot be opened or is not a regular file: a pipe could make the reader
  /// wait for ever.
  explicit LineReader(std::filesystem::path path);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

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
  bool fill();
  void take(std::size_t length);

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::unique_ptr<char[]> buffer_;
  std::size_t begin_ = 0;  // of what is not yet handed out
  std::size_t end_ = 0;
  std::string_view line_;
  std::int64_t number_ = 0;
  bool has_end_ = true;
  bool has_carriage_return_ = false;
};

}  // namespace hompm::detail
