#include "progress.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <unistd.h>

namespace hompm::cli {

ProgressBar::ProgressBar(bool quiet) : active_(!quiet && isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::update(std::int64_t step, std::int64_t steps) {
  if (!active_ || step < next_look_) return;
  next_look_ = step + std::max<std::int64_t>(
                          1, steps / 1000);  // the clock is read a thousand times in a run, not a million
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + std::chrono::milliseconds(100);
  draw(step, steps, std::chrono::duration<double>(now - start_).count());
}

void ProgressBar::draw(std::int64_t step, std::int64_t steps, double elapsed) {
  constexpr int width = 40;
  const double part = static_cast<double>(step) / static_cast<double>(steps);
  const auto filled = static_cast<std::size_t>(part * width);
  const std::string bar = std::string(filled, '#') + std::string(width - filled, '.');
  std::fprintf(stderr, "\r[%s] %3.0f %%, %.0f s left \033[K", bar.c_str(), 100.0 * part,
               elapsed / part - elapsed);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace hompm::cli
