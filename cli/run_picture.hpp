// Pictures of runs, from their folders.
#pragma once

#include <string>
#include <vector>

#include "common.hpp"

namespace hompm::cli {

/// Throws `UsageError` for pictures that cannot be: names of another ending, and, where runs that are there
/// already are named, options that ask for a new one.
void check_picture_options(const CommandLine& given);

/// Draws what --picture and --picture-xt ask for, of the runs in these folders. Their reference solutions may
/// take as long as --errors says. One line on standard error where there is no gnuplot; whether it was there.
/// Throws `FileError` for folders without a run, `UsageError` for runs that cannot be compared, and
/// `Interrupted`.
bool draw_runs(const CommandLine& given, const std::vector<std::string>& folders);

}  // namespace hompm::cli
