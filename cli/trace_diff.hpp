// hompm-diff --trace: where two runs part.
#pragma once

#include <string>

namespace hompm::cli {

enum class Report { text, json, none };

/// Compares the traces in the files `a` and `b` and prints what it found. Returns the exit code.
int diff_traces(const std::string& a, const std::string& b, Report report);

}  // namespace hompm::cli
