// Whatever the moment at which a run is killed, it loses at most one interval between checkpoints.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <hompm/kit/output/run_folder.hpp>
#include <hompm/kit/recorder/checkpoint.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using namespace hompm::test;
using Step = std::atomic<std::int64_t>;

namespace {

constexpr std::int64_t every = 25;

/// Runs the scene into `folder`, from the checkpoint there when there is one; `done` is the last step done.
void run_or_resume(const hompm::Scene& scene, const fs::path& folder, Step& done) {
  const bool resumed = fs::exists(folder / hompm::checkpoint_name);
  auto begin = resumed ? hompm::read_checkpoint(folder) : hompm::first_checkpoint(scene);
  begin.every = every;
  hompm::RunFolder files(folder, true);
  hompm::CheckpointWriter checkpoints(files, begin, [](const std::string&) { ::_exit(3); });
  for (const auto& row : begin.history) files.write(row);
  for (const auto& snapshot : begin.snapshots) files.write(snapshot);
  const auto both = [&](const auto& record) {
    files.write(record);
    checkpoints.keep(record);
  };
  hompm::RunObserver observer;
  observer.snapshot = both;
  observer.history = both;
  observer.progress = [&](std::int64_t step, std::int64_t) { done = step; };
  observer.checkpoint_every = every;
  observer.checkpoint = [&](const hompm::RunPoint& point) { checkpoints.write(point, 0.0); };
  run(scene, time_stepping(scene), observer, resumed ? &begin.point : nullptr);
  files.write("run.json", "{}\n");
  files.publish();
}

/// Files of `folder` with their content, by name.
std::map<std::string, std::string> content(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = read_file(entry.path());
  return files;
}

/// Memory that a child process shares.
class SharedStep {
 public:
  SharedStep()
      : step_(new (::mmap(nullptr, sizeof(Step), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))
                  Step(0)) {}
  ~SharedStep() { ::munmap(step_, sizeof(Step)); }
  SharedStep(const SharedStep&) = delete;
  SharedStep& operator=(const SharedStep&) = delete;
  Step& operator*() const { return *step_; }

 private:
  Step* step_;
};

}  // namespace

TEST_CASE("a run killed a hundred times loses at most one interval each time, and no byte") {
  const auto scene =
      built_in("bar", "large", {{"scheme.cells", "8"}, {"end_time", "0.05"}, {"output.snapshots", "10"}});
  const TemporaryFolder scratch;
  const SharedStep done;
  const auto start = std::chrono::steady_clock::now();
  run_or_resume(scene, scratch / "whole", *done);
  const auto took = std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start);
  const double longest = std::min(took.count(), 3e5);
  const auto whole = content(scratch / "whole");
  const fs::path folder = scratch / "killed";

  std::uint32_t seed = 2026;
  std::int64_t kept = 0;
  int kills = 0;
  int finished = 0;
  int resumed = 0;
  while (kills < 100) {
    *done = 0;
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      try {
        run_or_resume(scene, folder, *done);
      } catch (...) {
        ::_exit(2);
      }
      ::_exit(0);
    }
    seed = 1664525u * seed + 1013904223u;
    ::usleep(static_cast<useconds_t>(longest * static_cast<double>(seed >> 16U) / 65536.0));
    ::kill(child, SIGKILL);
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    if (WIFEXITED(status)) {
      REQUIRE(WEXITSTATUS(status) == 0);
      REQUIRE((content(folder) == whole));  // parentheses: not to be printed
      fs::remove_all(folder);
      kept = 0;
      ++finished;
      continue;
    }
    ++kills;
    const bool has_checkpoint = fs::exists(folder / hompm::checkpoint_name);
    const std::int64_t now = has_checkpoint ? hompm::read_checkpoint(folder).point.states.front().step : 0;
    // the one before step `done`, and never one older than before
    if (!fs::exists(folder / "run.json")) REQUIRE(now >= std::max(kept, (*done - 1) / every * every));
    kept = now;
    if (*done > every) ++resumed;
  }
  // and the last one comes to its end, with nothing left over
  run_or_resume(scene, folder, *done);
  CHECK((content(folder) == whole));
  INFO(finished << " runs finished");
  CHECK(resumed >= 10);
}
