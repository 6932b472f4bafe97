// Runs the points of a study on this machine, and writes the files it leaves behind: what is there already is
// kept, what is missing is run.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <hompm/kit/study/outcome.hpp>

namespace hompm::cli {

/// Whether valgrind is there and can run this program; not when it is built with the address sanitizer.
bool has_callgrind();

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

/// The outcomes of all points. Throws `FileError` naming one that is missing.
std::vector<study::Outcome> gathered(const StudyJob& job);
/// How many points have a record.
std::size_t gathered_count(const StudyJob& job);

/// points.csv, study.json, answers.txt, times.csv, and the pictures by gnuplot where it is there; prints the
/// answers unless the job is quiet. Returns the exit code: `invalid_run` where no point could be run. Throws
/// `FileError` as `gathered`.
int write_study_files(const StudyJob& job);

}  // namespace hompm::cli
