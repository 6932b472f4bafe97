// Signals that ask a program to end: it says so on one line and leaves nothing half-written.
#pragma once

#include <string>

namespace hompm::cli {

/// SIGINT, SIGTERM or SIGHUP came.
struct Interrupted {
  int signal;
  [[nodiscard]] int exit_code() const { return 128 + signal; }
  /// "SIGINT"
  [[nodiscard]] std::string name() const;
};

/// From here on one of these signals ends the program at once with "<tool>: stopped by SIGINT" and the exit
/// code of `Interrupted`, but for where a `HeldInterruption` lives. One that is ignored stays ignored: SIGHUP
/// under nohup, SIGINT in the background of a script. `tool` must outlive the program.
void catch_interruption(const char* tool);

/// As long as it lives, a signal is only noted. One at a time.
class HeldInterruption {
 public:
  HeldInterruption();
  ~HeldInterruption();
  HeldInterruption(const HeldInterruption&) = delete;
  HeldInterruption& operator=(const HeldInterruption&) = delete;
};

/// A signal was noted.
bool interrupted();
/// Throws `Interrupted` once a signal was noted.
void check_interruption();

}  // namespace hompm::cli
