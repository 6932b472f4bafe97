#include "study_run.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <mutex>
#include <thread>
#include <utility>

#include <hompm/kit/output/staging.hpp>
#include <hompm/kit/recorder/bytes.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/study/answers.hpp>
#include <hompm/kit/study/measure.hpp>

#include "child.hpp"
#include "common.hpp"
#include "interruption.hpp"

namespace hompm::cli {
namespace {

namespace fs = std::filesystem;

std::uint64_t number_after(const std::string& text, const std::string& label) {
  const auto found = text.find(label);
  return found == std::string::npos ? 0 : std::strtoull(text.c_str() + found + label.size(), nullptr, 10);
}

std::string program_path() { return fs::read_symlink("/proc/self/exe").string(); }

/// A hash of the running program's file, in hex: the same for one build, another for any other.
std::string program_id() {
  static const std::string id = hex(detail::hash_of_bytes(read_file(program_path())));
  return id;
}

/// Above 2 KB glibc copies and clears arrays by one repeated instruction, of which callgrind counts every
/// turn.
constexpr const char* vectors_at_any_size =
    "GLIBC_TUNABLES=glibc.cpu.x86_rep_movsb_threshold=0x40000000:glibc.cpu.x86_rep_stosb_threshold="
    "0x40000000";

/// Instructions in a few steps from the measured states: those of `Simulation::step`, to the digit. Throws
/// `Error` with what the child said when it fails, and what `check` throws, which is called while waiting and
/// ends the child.
study::Instructions count_instructions(const study::Measured& measured, const study::Check& check) {
  const Scratch scratch;
  study::write_moments(scratch.path(), measured);
  const std::string log = scratch.path() + "/log";
  const int code = run_child(
      {"env", vectors_at_any_size, "valgrind", "--tool=callgrind",
       "--callgrind-out-file=" + scratch.path() + "/out", "--collect-atstart=no",
       "--toggle-collect=hompm::Simulation::step(double)", program_path(), "--count", scratch.path()},
      log, log, check);
  const std::string said = study::text_of(log).value_or("");
  const auto counted = number_after(said, "Collected : ");
  const auto steps = number_after(said, "counted steps: ");
  if (code != 0 || counted == 0 || steps == 0)
    throw Error("counting instructions of " + measured.record.name + " failed (exit code " +
                std::to_string(code) +
                "): " + said.substr(said.size() - std::min<std::size_t>(said.size(), 300)));
  return study::extrapolated(counted, static_cast<std::int64_t>(steps), measured.record.work);
}

bool has_record(const StudyJob& job, const study::Point& point, const std::string& program) {
  const auto text = study::text_of(study::record_path(job.folder, point.name));
  if (!text) return false;
  try {
    const study::Record record = study::read_record(*text);
    if (!study::is_current(job.study, point, record, program)) return false;
    return record.instructions || record.scene.empty() || !job.instructions || !has_callgrind();
  } catch (const Error&) {
    return false;  // a damaged file: run the point anew
  }
}

/// What a point will take, about: the bar counts it.
std::int64_t planned_work(const study::Study& study, const study::Point& point) {
  try {
    Scene scene = study::scene_of(study, point);
    scene.scheme.allow_unstable = true;
    // Counting costs about as much as some hundred thousand particle steps.
    return time_stepping(scene).steps * scene.scheme.cells * scene.scheme.particles_per_cell + 500000;
  } catch (const SceneError&) {
    return 1;
  }
}

/// Times so far of a point, as long as they are of this program and scene.
study::Times times_so_far(const StudyJob& job, const study::Record& record) {
  study::Times times{record.name, record.program, record.scene, {}};
  if (const auto text = study::text_of(study::times_path(job.folder, record.name))) {
    study::Times found = study::read_times(*text);
    if (found.program == record.program && found.scene == record.scene)
      times.seconds = std::move(found.seconds);
  }
  return times;
}

}  // namespace

bool has_callgrind() {
#ifdef __SANITIZE_ADDRESS__
  return false;  // the two cannot run together
#else
  static const bool found = [] {
    const Scratch scratch;
    return run_child({"valgrind", "--version"}, scratch.path() + "/out", scratch.path() + "/log", [] {}) == 0;
  }();
  return found;
#endif
}

bool run_point(const StudyJob& job, const study::Point& point) {
  const std::string program = program_id();
  if (has_record(job, point, program)) return false;
  study::Measured measured = study::measure(job.study, point, program, check_interruption);
  if (job.instructions && has_callgrind() && !measured.moments.empty())
    measured.record.instructions = count_instructions(measured, check_interruption);
  detail::write_whole(study::record_path(job.folder, point.name), study::record_text(measured.record));
  return true;
}

void run_points(const StudyJob& job, unsigned workers) {
  std::vector<std::pair<std::int64_t, const study::Point*>> queue;  // the longest first: workers end together
  std::int64_t all = 0;
  const std::string program = program_id();
  for (const study::Point& point : job.points) {
    if (has_record(job, point, program)) continue;
    queue.emplace_back(planned_work(job.study, point), &point);
    all += queue.back().first;
  }
  std::stable_sort(queue.begin(), queue.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  if (!job.quiet && queue.size() < job.points.size())
    std::cout << "points    " << job.points.size() - queue.size() << " of " << job.points.size()
              << " are there already\n"
              << std::flush;

  ProgressBar bar(job.quiet);
  std::mutex mutex;
  std::size_t next = 0;
  std::int64_t done = 0;
  std::exception_ptr failure;
  const auto work = [&] {
    for (;;) {
      std::pair<std::int64_t, const study::Point*> mine;
      {
        const std::lock_guard lock(mutex);
        if (failure || next == queue.size()) return;
        mine = queue[next++];
      }
      try {
        run_point(job, *mine.second);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        return;
      }
      const std::lock_guard lock(mutex);
      done += mine.first;
      bar.update(done, all);
    }
  };
  std::vector<std::thread> threads;
  for (unsigned i = 1; i < std::min<std::size_t>(workers, queue.size()); ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

void run_times(const StudyJob& job, int rounds) {
  const std::string program = program_id();
  const auto gathered = study::gather(job.study, job.points, job.folder, program);
  struct Run {
    Scene scene;
    study::Times times;
  };
  std::vector<Run> runs;
  std::int64_t all = 0;
  for (const study::Outcome& outcome : gathered.outcomes) {
    const study::Status status = outcome.record.status;
    if (status != study::Status::ok && status != study::Status::unjudged) continue;
    study::Times times = times_so_far(job, outcome.record);
    const auto missing = rounds - static_cast<std::int64_t>(times.seconds.size());
    if (missing <= 0) continue;
    all += missing * outcome.record.work.particle_steps();
    runs.push_back({study::measured_scene(job.study, outcome.point), std::move(times)});
  }
  if (runs.empty()) return;
  if (!job.quiet)
    std::cout << "timing    " << runs.size() << " points, one run at a time, up to " << rounds
              << " rounds: keep the machine free for it\n"
              << std::flush;
  ProgressBar bar(job.quiet);
  std::int64_t done = 0;
  for (int round = 0; round < rounds; ++round)
    for (Run& run : runs) {
      if (static_cast<int>(run.times.seconds.size()) > round) continue;
      check_interruption();
      run.times.seconds.push_back(study::timed(run.scene));
      detail::write_whole(study::times_path(job.folder, run.times.name), study::times_text(run.times));
      done += std::int64_t{run.scene.scheme.cells} * run.scene.scheme.particles_per_cell *
              time_stepping(run.scene).steps;
      bar.update(done, all);
    }
}

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
    detail::write_whole(job.folder / name, text);
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
