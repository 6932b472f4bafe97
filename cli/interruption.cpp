#include "interruption.hpp"

#include <array>
#include <csignal>
#include <cstring>
#include <unistd.h>

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

}  // namespace hompm::cli
