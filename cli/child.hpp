// Other programs that a tool runs, gnuplot among them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <hompm/kit/output/gnuplot.hpp>

namespace hompm::cli {

/// A folder of its own below that for temporary files, gone with the object.
class Scratch {
 public:
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

inline constexpr int no_such_program = 127;

/// Runs a command, with nothing to read, standard output in the file `out` and standard error in `log`, which
/// may be the same; its exit code, 128 + the signal that ended it, or `no_such_program`. `check` is called
/// while waiting; what it throws ends the child.
int run_child(std::vector<std::string> command, const std::string& out, const std::string& log,
              const std::function<void()>& check);

/// What gnuplot writes to standard output for `script`; nothing when it is not installed. Throws `FileError`
/// with what gnuplot says when it fails.
std::optional<std::string> run_gnuplot(const std::string& script);

/// Throws `UsageError`, which begins with `option`, when the name of a picture has no ending that gnuplot
/// can write.
void require_picture_name(const std::string& option, const std::string& file);

/// Draws the picture, which appears whole or not at all. Says what is in the way where there is nothing to
/// draw with, or ""; FILE.gnuplot, which draws it later, is then left in its place. Throws `FileError`.
std::string draw(const gnuplot::Picture& picture, const std::string& file);

}  // namespace hompm::cli
