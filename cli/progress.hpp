// A progress bar on standard error: only on a terminal, and only for runs longer than a second.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace hompm::cli {

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
