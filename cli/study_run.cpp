#include "study_run.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <iostream>
#include <mutex>
#include <thread>

#include <hompm/error.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/study/measure.hpp>
#include <hompm/study/outcome.hpp>

#include "callgrind.hpp"
#include "interruption.hpp"
#include "progress.hpp"

namespace hompm::cli {
namespace {

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

bool run_point(const StudyJob& job, const study::Point& point) {
  const std::string program = program_id();
  if (has_record(job, point, program)) return false;
  study::Measured measured = study::measure(job.study, point, program, check_interruption);
  if (job.instructions && has_callgrind() && !measured.moments.empty())
    measured.record.instructions = count_instructions(measured, check_interruption);
  study::write_whole(study::record_path(job.folder, point.name), study::record_text(measured.record));
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
      study::write_whole(study::times_path(job.folder, run.times.name), study::times_text(run.times));
      done += std::int64_t{run.scene.scheme.cells} * run.scene.scheme.particles_per_cell *
              time_stepping(run.scene).steps;
      bar.update(done, all);
    }
}

}  // namespace hompm::cli
