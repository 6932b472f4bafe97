// Errors the library throws. Each carries a message made for the reader; the command line turns the type
// into an exit code.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace hompm {

/// Where a value was said: a scene file with line and column, or a command-line option.
struct Origin {
  std::string source;  ///< file name, "--cells", or "built-in scene column-large"
  int line = 0;        ///< 1-based; 0 when the source has no lines
  int column = 0;      ///< 1-based; 0 when the source has no lines

  /// "file:line:column", or the source alone when it has no lines.
  [[nodiscard]] std::string text() const;
};

/// Base of all errors of the library.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One thing wrong with a scene: where, and what to do about it.
struct Problem {
  Origin origin;
  std::string message;
};

/// A scene or an option that cannot be computed. Thrown before anything is computed or written.
class SceneError : public Error {
 public:
  /// `problems` must not be empty; `what()` joins the first hundred, one line each, as "origin: message".
  explicit SceneError(std::vector<Problem> problems);
  SceneError(const Origin& origin, const std::string& message);
  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// A run that stopped being valid: unstable, inverted, left the grid.
class InvalidRun : public Error {
 public:
  /// `particle` is 0-based, or −1 where no single particle is to blame; `step` counts from 1, `time` in s.
  InvalidRun(std::int64_t step, double time, std::int64_t particle, const std::string& reason);
  std::int64_t step;
  double time;
  std::int64_t particle;
  std::string reason;
};

/// A build or process that does not compute as IEEE 754 says with rounding to nearest.
class ArithmeticError : public Error {
 public:
  using Error::Error;
};

/// A file or folder that cannot be read or written; `what()` names the path and the system's reason.
class FileError : public Error {
 public:
  using Error::Error;
  /// "cannot <action> <path>: <the system's reason for error_number>".
  FileError(std::string_view action, const std::filesystem::path& path, int error_number);
};

/// All of a file, of at most `most` bytes. Throws `FileError` for one that cannot be read, or is larger.
std::string read_file(const std::filesystem::path& path, std::size_t most = std::size_t(-1));

}  // namespace hompm
