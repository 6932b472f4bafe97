#include "gnuplot.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <hompm/error.hpp>

namespace hompm::cli {
namespace {

/// A file without a name, gone when it is closed. Pipes could fill up and hang; a file cannot.
class NamelessFile {
 public:
  NamelessFile() : file_(std::tmpfile(), &std::fclose) {
    if (!file_) throw FileError("create", "a temporary file", errno);
  }
  [[nodiscard]] int descriptor() const { return ::fileno(file_.get()); }
  void fill(const std::string& text) {
    const bool written = std::fwrite(text.data(), 1, text.size(), file_.get()) == text.size();
    if (!written || std::fflush(file_.get()) != 0) throw FileError("write", "a temporary file", errno);
    std::rewind(file_.get());
  }
  std::string content() {
    std::rewind(file_.get());
    std::string all;
    std::array<char, 65536> buffer{};
    while (const auto count = std::fread(buffer.data(), 1, buffer.size(), file_.get())) {
      all.append(buffer.data(), count);
    }
    return all;
  }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

std::string first_lines(const std::string& text) {
  std::string line;
  for (const char c : text.substr(0, 300)) line += c == '\n' ? ' ' : c;
  return line;
}

}  // namespace

std::optional<std::string> run_gnuplot(const std::string& script) {
  NamelessFile input;
  NamelessFile output;
  NamelessFile errors;
  input.fill(script);

  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, input.descriptor(), STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, output.descriptor(), STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, errors.descriptor(), STDERR_FILENO);
  std::string name = "gnuplot";
  std::string own_settings = "-d";  // none of the user's: the same picture for everybody
  const std::array<char*, 3> arguments{name.data(), own_settings.data(), nullptr};
  pid_t process = 0;
  const int failure = ::posix_spawnp(&process, name.c_str(), &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (failure == ENOENT) return std::nullopt;
  if (failure != 0) throw FileError("start", name, failure);

  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (status != 0) throw FileError("gnuplot failed: " + first_lines(errors.content()));
  return output.content();
}

}  // namespace hompm::cli
