// The files a study leaves behind: tables, pictures, answers.
#pragma once

#include <cstddef>
#include <vector>

#include <hompm/study/outcome.hpp>

#include "study_run.hpp"

namespace hompm::cli {

/// The outcomes of all points. Throws `FileError` naming one that is missing.
std::vector<study::Outcome> gathered(const StudyJob& job);
/// How many points have a record.
std::size_t gathered_count(const StudyJob& job);

/// points.csv, study.json, answers.txt, times.csv, and the pictures by gnuplot where it is there; prints the
/// answers unless the job is quiet. Returns the exit code: `invalid_run` where no point could be run. Throws
/// `FileError` as `gathered`.
int write_study_files(const StudyJob& job);

}  // namespace hompm::cli
