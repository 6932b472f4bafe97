#include "progress.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <unistd.h>
#include <utility>

namespace hompm::cli {

ProgressBar::ProgressBar(bool quiet, std::string what, std::int64_t from)
    : active_(!quiet && isatty(STDERR_FILENO) == 1), what_(std::move(what)), from_(from) {}

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
  constexpr std::int64_t one = 1;
  const double part = static_cast<double>(step) / static_cast<double>(steps);
  const auto filled = static_cast<std::size_t>(part * width);
  const std::string bar = std::string(filled, '#') + std::string(width - filled, '.');
  const double left = static_cast<double>(steps - step) / static_cast<double>(std::max(step - from_, one));
  std::fprintf(stderr, "\r%s[%s] %3.0f %%, %.0f s left \033[K", what_.c_str(), bar.c_str(), 100.0 * part,
               elapsed * left);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace hompm::cli
