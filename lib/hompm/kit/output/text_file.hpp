// A text file that is written in large pieces, every one of them checked.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace hompm::detail {

/// What is written may stay in the buffer until `close`, so only `close` says that all of it reached the
/// file.
class TextFile {
 public:
  /// Creates or empties the file at `path`; messages call it `shown`. Throws `FileError`.
  TextFile(const std::filesystem::path& path, std::filesystem::path shown);
  /// Closes without writing what is still in the buffer: a file that was not closed is not wanted.
  ~TextFile();
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;

  /// Appends text. Throws `FileError` when the disk is full, a limit is reached or the device fails.
  TextFile& operator<<(std::string_view text);
  /// Appends the shortest text that reads back to `value`. Throws `Error` when it is not finite.
  TextFile& operator<<(double value);
  /// Appends a whole number.
  TextFile& operator<<(std::size_t value);

  /// Writes the rest and closes; a second call does nothing. Throws `FileError`.
  void close();
  /// The same, and the content has reached the disk when it returns.
  void close_on_disk();

 private:
  void flush();

  std::filesystem::path shown_;
  std::string buffer_;
  int descriptor_ = -1;
};

}  // namespace hompm::detail
