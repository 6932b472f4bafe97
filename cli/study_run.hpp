// Runs the points of a study on this machine: what is there already is kept, what is missing is run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <hompm/study/study.hpp>

namespace hompm::cli {

struct StudyJob {
  study::Study study;
  std::vector<study::Point> points;
  std::filesystem::path folder;
  bool instructions = true;  ///< count them
  bool quiet = false;
};

/// Runs one point if it has no current record; counted instructions are part of a current one where they are
/// wanted and valgrind is there. True when something was run.
bool run_point(const StudyJob& job, const study::Point& point);

/// Runs all points, `workers` at a time. Throws `Interrupted` and the first failure, with all records so far
/// in place.
void run_points(const StudyJob& job, unsigned workers);

/// Takes `rounds` times of each valid point, one run at a time, in rounds over all points.
void run_times(const StudyJob& job, int rounds);

}  // namespace hompm::cli
