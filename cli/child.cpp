#include "child.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include <hompm/kit/output/staging.hpp>
#include <hompm/kit/study/record.hpp>

#include "common.hpp"

namespace hompm::cli {

Scratch::Scratch() : path_((std::filesystem::temp_directory_path() / "hompm-XXXXXX").string()) {
  if (::mkdtemp(path_.data()) == nullptr) throw FileError("create the folder", path_, errno);
}

Scratch::~Scratch() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

int run_child(std::vector<std::string> command, const std::string& out, const std::string& log,
              const std::function<void()>& check) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 2, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (out == log)
    posix_spawn_file_actions_adddup2(&files, 2, 1);
  else
    posix_spawn_file_actions_addopen(&files, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t child = 0;
  const int failed = ::posix_spawnp(&child, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (failed == ENOENT) return no_such_program;
  if (failed != 0) throw FileError("start", command.front(), failed);
  int status = 0;
  try {
    while (::waitpid(child, &status, WNOHANG) == 0) {
      check();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  } catch (...) {
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
    throw;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::optional<std::string> run_gnuplot(const std::string& script) {
  const Scratch scratch;
  const auto file = [&](const char* name) { return scratch.path() + "/" + name; };
  detail::write_whole(file("script"), script);
  // -d: none of the user's settings, the same picture for everybody.
  const int code = run_child({"gnuplot", "-d", file("script")}, file("out"), file("log"), [] {});
  if (code == no_such_program) return std::nullopt;
  if (code == 0) return read_file(file("out"));
  std::string said = read_file(file("log")).substr(0, 300);
  std::ranges::replace(said, '\n', ' ');
  throw FileError("gnuplot failed: " + said);
}

void require_picture_name(const std::string& option, const std::string& file) {
  const std::string ending = std::filesystem::path(file).extension();
  if (std::ranges::find(gnuplot::endings, ending) != std::end(gnuplot::endings)) return;
  throw UsageError(option + " " + file + ": the name must end in .svg, .png or .pdf" +
                   suggestion(ending, {std::begin(gnuplot::endings), std::end(gnuplot::endings)}));
}

std::string draw(const gnuplot::Picture& picture, const std::string& file) {
  const auto path = std::filesystem::absolute(file);
  detail::StagingFolder staging(path.parent_path());
  if (const auto drawn = run_gnuplot(gnuplot::script(picture, path.extension().string(), ""))) {
    staging.replace(path.filename(), *drawn);
    return "";
  }
  const std::string name = path.stem().string() + ".gnuplot";
  staging.replace(name, gnuplot::script(picture, path.extension().string(), path.filename()));
  return "gnuplot is not installed (Debian package gnuplot-nox); its script is " +
         std::filesystem::path(file).replace_filename(name).string();
}

}  // namespace hompm::cli
