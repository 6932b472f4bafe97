#include "study_files.hpp"

#include <algorithm>
#include <iostream>

#include <hompm/error.hpp>
#include <hompm/study/answers.hpp>
#include <hompm/study/picture.hpp>
#include <hompm/study/tables.hpp>

#include "callgrind.hpp"
#include "common.hpp"
#include "gnuplot.hpp"

namespace hompm::cli {
namespace {

/// Runs gnuplot on a script in its folder; false when there is none, or it fails.
bool draw(const std::filesystem::path& folder, const std::string& script) {
  std::string place;  // in a text of gnuplot's a quote is written twice
  for (const char c : folder.string()) place += c == '\'' ? "''" : std::string(1, c);
  try {
    return run_gnuplot("cd '" + place + "'\nload '" + script + "'\n").has_value();
  } catch (const FileError&) {
    return false;
  }
}

std::string title_of(const study::Study& study) {
  if (!study.scene_file.empty()) return std::filesystem::path(study.scene_file).stem().string();
  return study.case_name + (study.variant.empty() ? "" : " " + study.variant);
}

}  // namespace

std::vector<study::Outcome> gathered(const StudyJob& job) {
  auto found = study::gather(job.study, job.points, job.folder, program_id());
  if (!found.missing.empty())
    throw FileError(std::to_string(found.missing.size()) + " of " + std::to_string(job.points.size()) +
                    " points have no current record in " + (job.folder / "points").string() + ": " +
                    found.missing.front() + (found.missing.size() > 1 ? ", …" : ""));
  return std::move(found.outcomes);
}

std::size_t gathered_count(const StudyJob& job) {
  return study::gather(job.study, job.points, job.folder, program_id()).outcomes.size();
}

int write_study_files(const StudyJob& job) {
  const std::vector<study::Outcome> outcomes = gathered(job);
  std::vector<study::Outcome> untimed = outcomes;  // what does not depend on the clock
  for (study::Outcome& outcome : untimed) outcome.seconds.clear();
  const study::Cost cost = study::steady_cost(outcomes);
  const auto write = [&](const std::string& name, const std::string& text) {
    study::write_whole(job.folder / name, text);
  };
  write("points.csv", study::points_csv(untimed));
  write("study.json", study::study_json(job.study, untimed));
  write("answers.txt", study::answers(untimed, cost) + study::remarks(untimed));
  bool drawn = true;
  const auto picture = [&](const std::string& name, study::Cost against) {
    write(name + ".gnuplot", study::picture_script(outcomes, against, title_of(job.study), name));
    drawn = draw(job.folder, name + ".gnuplot") && drawn;
  };
  picture("error-" + std::string(cost == study::Cost::instructions ? "instructions" : "particle-steps"),
          cost);
  const bool timed = study::times_csv(outcomes) != study::times_csv(untimed);
  if (timed) {
    write("times.csv", study::times_csv(outcomes));
    picture("error-seconds", study::Cost::seconds);
  }
  if (!drawn)
    std::cerr << "hompm-study: gnuplot is not there or failed, so there are scripts instead of pictures\n";
  if (!job.quiet)
    std::cout << study::answers(outcomes, cost) << study::remarks(outcomes) << "files     "
              << job.folder.string() << "\n";
  const bool ran = std::ranges::any_of(outcomes, [](const study::Outcome& outcome) {
    return outcome.record.status == study::Status::ok || outcome.record.status == study::Status::unjudged;
  });
  if (!ran)
    std::cerr << "hompm-study: no point could be run\n" << (job.quiet ? study::remarks(outcomes) : "");
  return ran ? success : invalid_run;
}

}  // namespace hompm::cli
