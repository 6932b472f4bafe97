// What a reader must never do, told to libFuzzer by a crash.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

/// Ends the program with `what` unless it holds.
inline void demand(bool holds, const std::string& what) {
  if (holds) return;
  std::fprintf(stderr, "demand not met: %s\n", what.c_str());
  std::abort();
}

/// One line of a message: not empty, not long, without control characters.
inline bool is_line(const std::string& text) {
  return !text.empty() && text.size() < 2000 &&
         std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}
