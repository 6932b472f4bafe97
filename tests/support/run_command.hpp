// Runs a shell command the way a user would and keeps all it says.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <sys/wait.h>

#include "support/temporary_folder.hpp"

namespace hompm::test {

/// What a command left behind.
struct CommandResult {
  int exit_code = -1;  ///< 128 + n when signal n ended it
  std::string out;     ///< standard output
  std::string err;     ///< standard error
};

/// `text` as one word of the shell, whatever it holds.
inline std::string quoted(const std::string& text) {
  std::string word = "'";
  for (const char c : text) {
    if (c == '\'') {
      word += "'\\''";
    } else {
      word += c;
    }
  }
  return word + "'";
}

/// Runs `command` in /bin/sh with empty standard input. Output goes through files, so no pipe can fill up and
/// hang.
inline CommandResult run_command(const std::string& command) {
  const TemporaryFolder scratch;
  const std::string out = (scratch / "out").string();
  const std::string err = (scratch / "err").string();
  const std::string line = "(\n" + command + "\n) </dev/null >" + quoted(out) + " 2>" + quoted(err);
  const int status = std::system(line.c_str());
  CommandResult result;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = read_file(out);
  result.err = read_file(err);
  return result;
}

}  // namespace hompm::test
