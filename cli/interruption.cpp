#include "interruption.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <unistd.h>
#include <utility>

namespace hompm::cli {
namespace {

constexpr std::array signals{SIGINT, SIGTERM, SIGHUP};

const char* name_of(int signal) {
  return signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "SIGHUP";
}

// What a signal handler may use.
volatile std::sig_atomic_t held = 0;
volatile std::sig_atomic_t noted = 0;
const char* said_by = "";

void handle(int signal) {
  if (held != 0) {
    noted = signal;
    return;
  }
  for (const char* text : {said_by, ": stopped by ", name_of(signal), "\n"})
    if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
  ::_exit(128 + signal);
}

}  // namespace

std::string Interrupted::name() const { return name_of(signal); }

void catch_interruption(const char* tool) {
  said_by = tool;
  struct sigaction action {};
  action.sa_handler = handle;
  action.sa_flags = SA_RESTART;
  for (const int signal : signals) ::sigaddset(&action.sa_mask, signal);
  for (const int signal : signals) {
    struct sigaction before {};
    ::sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) ::sigaction(signal, &action, nullptr);
  }
}

HeldInterruption::HeldInterruption() { held = 1; }
HeldInterruption::~HeldInterruption() { held = 0; }

bool interrupted() { return noted != 0; }

void check_interruption() {
  if (noted != 0) throw Interrupted{noted};
}

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
