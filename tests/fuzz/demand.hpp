// What a reader must never do, told to libFuzzer by a crash.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

/// Ends the program with `what` unless it holds.
inline void demand(bool holds, const std::string& what) {
  if (holds) return;
  std::fprintf(stderr, "demand not met: %s\n", what.c_str());
  std::abort();
}
