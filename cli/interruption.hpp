// What a tool that computes for long shows, and how it ends: a bar on standard error, and signals, which
// leave one line and nothing half-written.
#pragma once

#include <chrono>
#include <cstdint>
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

class ProgressBar {
 public:
  /// `what` stands in front of the bar; the work begins after `from` steps, which cost nothing now.
  explicit ProgressBar(bool quiet, std::string what = "", std::int64_t from = 0);
  /// Erases the bar, so that what is printed next stands alone.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// To be called after every step; draws at most ten times a second.
  void update(std::int64_t step, std::int64_t steps);

 private:
  using Clock = std::chrono::steady_clock;
  void draw(std::int64_t step, std::int64_t steps, double elapsed);

  bool active_;
  std::string what_;
  std::int64_t from_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_ = start_ + std::chrono::seconds(1);
  std::int64_t next_look_ = 0;
};

}  // namespace hompm::cli
