#include "scene_run.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <sys/resource.h>
#include <unistd.h>
#include <utility>
#include <vector>

#include <hompm/kit/output/run_report.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/verify/made_reference.hpp>
#include <hompm/number.hpp>
#include <hompm/simulation/warnings.hpp>

#include "findings.hpp"
#include "interruption.hpp"
#include "listing.hpp"

namespace hompm::cli {
namespace {

namespace fs = std::filesystem;

struct Limit {
  double bytes;
  std::string name;
};

void lower(Limit& limit, double bytes, const std::string& name) {
  if (bytes < limit.bytes) limit = {bytes, name};
}

void lower_by_resource(Limit& limit, decltype(RLIMIT_AS) resource, const std::string& name) {
  struct rlimit set {};
  if (::getrlimit(resource, &set) == 0 && set.rlim_cur != RLIM_INFINITY)
    lower(limit, static_cast<double>(set.rlim_cur), name);
}

/// Those of the group and of all above it; "max" and a file that is not there are none.
void lower_by_control_groups(Limit& limit) {
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const auto first = line.find(':');
    const auto second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool unified = controllers.empty();
    if (!unified && controllers != "memory") continue;
    const std::string root = unified ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
    const char* const file = unified ? "memory.max" : "memory.limit_in_bytes";
    std::filesystem::path path = line.substr(second + 1);
    for (;; path = path.parent_path()) {
      std::ifstream set(root / path.relative_path() / file);
      double bytes = 0.0;
      if (set >> bytes) lower(limit, bytes, "the control group");
      if (!path.has_relative_path()) break;
    }
  }
}

std::string megabytes(double bytes) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.0f MB", bytes / 1e6);
  return text.data();
}

/// What a run keeps beside its state.
struct Keeps {
  bool checkpoints = false;  ///< all that was reported
  bool trace = false;        ///< the state before each stage
};

/// About how many bytes a run takes at least: measured for every scheme, and found to be linear.
double estimated_memory(const Scene& scene, const Keeps& keeps) {
  constexpr double program = 16e6;
  double bytes = program;
  for (const Scene* body : bodies_of(scene)) {
    const SchemeSpec& scheme = body->scheme;
    const double cells = scheme.cells + 2.0 * scheme.margin_cells;
    const double particles = 1.0 * scheme.cells * scheme.particles_per_cell;
    const double functions = scheme.degree + 1.0;  // that a particle sees
    double each = 372.0 + 64.0 * functions;
    if (keeps.checkpoints) each += 3.0 * 64.0 * (scene.output.snapshots + 1.0) + 130.0;
    if (keeps.trace) each += 100.0 + 16.0 * functions;
    bytes += particles * each;
    bytes += cells * (scheme.choices.quadrature == Quadrature::particles ? 80.0 : 600.0);
  }
  return bytes;
}

/// Throws `SceneError` with both numbers when that is more than this process may have: physical memory, the
/// limits of its address space (ulimit -v) and data, and those of its control group.
void demand_memory(const Scene& scene, const Keeps& keeps) {
  const double needed = estimated_memory(scene, keeps);
  Limit limit{static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE)),
              "the machine"};
  lower_by_resource(limit, RLIMIT_AS, "ulimit -v");
  lower_by_resource(limit, RLIMIT_DATA, "ulimit -d");
  lower_by_control_groups(limit);
  if (needed <= limit.bytes) return;
  throw SceneError(scene.origin_of("scheme.cells"),
                   "the run needs about " + megabytes(needed) + " of memory, and " + limit.name + " has " +
                       megabytes(limit.bytes) + ": take fewer cells or particles" +
                       (keeps.checkpoints ? ", or fewer snapshots, which checkpoints hold" : ""));
}

class Stopwatch {
 public:
  /// Shows `before` (s) at the start.
  explicit Stopwatch(double before = 0.0) : before_(before) {}
  [[nodiscard]] double seconds() const {
    return before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  double before_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

fs::path output_folder(const CommandLine& given, const Scene& scene) {
  if (given.has("output")) return given.text("output");
  if (given.has("resume")) return checkpoint_folder(given.text("resume"));
  std::string name = scene.case_name;
  if (!scene.variant.empty()) name += "-" + scene.variant;
  return fs::path("hompm-out") /
         (name + "-" + scene.scheme.name + "-p" + std::to_string(scene.scheme.degree) + "-" +
          std::to_string(scene.scheme.cells));
}

/// What is told where a run of another scene is in a folder that nobody named; "" where there is none.
std::string replaced(const fs::path& folder, const CommandLine& given, const Scene& scene) {
  std::error_code ignored;
  if (given.has("output") || given.has("resume") || !fs::exists(folder / "scene.toml", ignored)) return "";
  const std::string there = read_file(folder / "scene.toml");
  const std::string here = scene_text(scene);
  if (here == there) return "";
  return "the run of another scene in " + folder.string() +
         " is replaced (--output DIR keeps it): " + first_different_line(here, there);
}

namespace {

/// Throws `FileError` where --no-clobber forbids to replace what is there.
void demand_no_run(const RunFolder& folder, bool resumed) {
  std::string found = folder.earlier_run();
  std::error_code ignored;
  if (found.empty() && !resumed && fs::exists(folder.path() / checkpoint_name, ignored))
    found = checkpoint_name;
  if (!found.empty())
    throw FileError("cannot write in " + folder.path().string() + ": there is a run already, its " + found +
                    ", and --no-clobber was given");
}

int check_against(const fs::path& golden, const fs::path& folder, bool quiet) {
  const Comparison comparison = compare_folders(folder, golden, {}, true);
  const bool same = comparison.verdict == Verdict::identical;
  if (!quiet || !same)
    (quiet ? std::cerr : std::cout) << "  golden    " << golden.string() << ": " << text_of(comparison);
  return same ? success : different;
}

/// How a run begins: anew, or where the checkpoint `from` was written.
Checkpoint starting_point(const Scene& scene, const CommandLine& given, std::optional<Checkpoint> from) {
  Checkpoint point = from ? std::move(*from) : first_checkpoint(scene);
  point.scene = scene;
  point.vtk = point.vtk && !given.has("no-vtk");
  if (given.has("checkpoint")) point.every = parse_steps(given.text("checkpoint"), "--checkpoint", 1);
  point.keep = point.keep || given.has("keep-checkpoint");
  if (given.has("errors") || given.has("check")) point.errors = errors_asked_for(given);
  return point;
}

/// The trace that --trace asks for, or the table that --dump-steps does; nothing without.
std::unique_ptr<Trace> asked_trace(const CommandLine& given, RunFolder& folder) {
  TraceOptions options;
  if (given.has("dump-steps")) {
    given.refuse({"trace", "resume"}, "--dump-steps takes no");
    options.table_steps = parse_steps(given.text("dump-steps"), "--dump-steps", 1);
    return std::make_unique<Trace>(folder.add("steps.csv"), options);
  }
  if (given.has("trace-values")) {
    if (!given.has("trace")) throw UsageError("--trace-values goes with --trace");
    options.values_from = parse_steps(given.text("trace-values"), "--trace-values", 0);
  }
  if (!given.has("trace")) return nullptr;
  return std::make_unique<Trace>(given.text("trace"), options);
}

void say_stopped(const Interrupted& signal, const std::string& rest) {
  std::cerr << "hompm-run: stopped by " << signal.name() << rest << std::endl;
}

struct BudgetUsedUp {};

/// How much a reference may cost.
struct Budget {
  std::string asked;  ///< auto, full, none
  double seconds;     ///< of a known solution, with auto
  double work;        ///< counted, of runs where none is known
};

/// Errors against the reference solution as far as they are asked for; `reason` says why there are none.
/// Throws `Interrupted`.
std::optional<ErrorReport> errors_of(const Scene& scene, const RunResult& result, const RunMotion& motion,
                                     const Budget& budget, bool quiet, std::string& reason) {
  std::optional<ErrorReport> errors;
  const auto work = [&](const ReferenceWatch& watch) {
    errors = judge(scene, result, reason, watch, motion);
  };
  if (!within_budget(budget.asked, budget.seconds, quiet, reason, work) || errors) return errors;
  // What runs may cost is counted, not timed: whether there are errors must not depend on the clock.
  ProgressBar bar(quiet, "errors ");
  std::string no_runs;
  const auto show = [&](double part) {
    check_interruption();
    constexpr double parts = 1e6;
    bar.update(static_cast<std::int64_t>(parts * part), static_cast<std::int64_t>(parts));
  };
  errors = judge_by_runs(scene, result, budget.work, no_runs, show, motion);
  if (!errors) reason += "; " + no_runs;
  return errors;
}

}  // namespace

std::string errors_asked_for(const CommandLine& given) {
  if (!given.has("errors")) return given.has("check") ? "full" : "auto";
  std::string asked = given.text("errors");
  if (asked != "auto" && asked != "full" && asked != "none")
    throw UsageError("--errors " + asked + ": there are auto, full, none" +
                     suggestion(asked, {"auto", "full", "none"}));
  return asked;
}

bool within_budget(const std::string& asked, double seconds, bool quiet, std::string& reason,
                   const std::function<void(const ReferenceWatch&)>& work) {
  if (asked == "none") {
    reason = "--errors none was given";
    return false;
  }
  constexpr double least = 2.0;  // s
  const Stopwatch clock;
  ProgressBar bar(quiet, "errors ");
  try {
    work([&](double part) {
      check_interruption();
      if (asked == "auto" && clock.seconds() > std::max(seconds, least)) throw BudgetUsedUp();
      constexpr double parts = 1e6;
      bar.update(static_cast<std::int64_t>(parts * part), static_cast<std::int64_t>(parts));
    });
    return true;
  } catch (const BudgetUsedUp&) {
    reason = "the reference solution takes longer than the run; --errors full computes it all the same";
    return false;
  }
}

int run_scene(Scene scene, const CommandLine& given, std::optional<Checkpoint> from) {
  const bool quiet = given.has("quiet");
  const bool resumed = from.has_value();
  demand_memory(scene, {.checkpoints = given.has("checkpoint") || given.has("keep-checkpoint"),
                        .trace = given.has("trace")});
  const auto form = given.has("json") ? Form::json : Form::text;
  if (given.has("critical-step")) {
    std::cout << critical_steps(scene, form);
    return success;
  }
  const TimeStepping stepping =
      resumed ? resumed_stepping(scene, from->point.states.front().time_step) : time_stepping(scene);
  const Checkpoint begin = starting_point(scene, given, std::move(from));
  const std::int64_t done = begin.point.states.front().step;
  if (resumed && done >= stepping.steps)
    throw CheckpointError("cannot resume from " + given.text("resume") +
                          ": the run has come to its end, t = " + to_text(scene.end_time) +
                          " s; --end-time asks for a later one");
  if (given.has("explain")) {
    std::cout << explanation(scene, stepping, form);
    return success;
  }
  const auto tell = [&](std::span<const Warning> warnings) {
    for (const Warning& warning : warnings)
      if (!quiet) warn(warning.text);
  };
  const std::vector<Warning> warnings = warnings_before(scene, stepping);
  tell(warnings);

  // 1. The steps.
  const HeldInterruption held;
  RunFolder folder(output_folder(given, scene), begin.vtk);
  const std::string where = folder.path().string();
  if (given.has("no-clobber")) demand_no_run(folder, resumed);
  auto trace = asked_trace(given, folder);
  const Stopwatch clock(begin.seconds);
  std::optional<CheckpointWriter> checkpoints;
  if (begin.every > 0 || begin.keep) checkpoints.emplace(folder, begin, warn);
  if (!resumed && !quiet && fs::exists(folder.path() / checkpoint_name))
    warn("the run that was stopped in " + where + " is replaced (--resume " + where +
         " would go on with it)");
  if (const std::string told = replaced(folder.path(), given, scene); !told.empty() && !quiet) warn(told);
  for (const auto& row : begin.history) folder.write(row);
  for (const auto& snapshot : begin.snapshots) folder.write(snapshot);
  folder.write_probes(begin.probes);
  Snapshot last_valid = begin.snapshots.empty() ? Snapshot{} : begin.snapshots.back();
  RunMotion motion;
  for (const auto& snapshot : begin.snapshots) motion.look(scene, snapshot);

  RunObserver observer;
  const auto keep = [&](const auto& record) {
    folder.write(record);
    if (checkpoints) checkpoints->keep(record);
  };
  observer.snapshot = [&](const Snapshot& snapshot) {
    keep(snapshot);
    motion.look(scene, snapshot);
    last_valid = snapshot;
  };
  observer.history = keep;
  observer.probe = [&](const ProbeRow& row) {
    folder.write_probes(detail::probe_text(row));
    if (checkpoints) checkpoints->keep(row);
  };
  if (checkpoints)
    observer.checkpoint = [&](const RunPoint& point) { checkpoints->write(point, clock.seconds()); };
  observer.checkpoint_every = begin.every;
  observer.checkpoint_at_end = begin.keep;
  observer.stop = interrupted;
  if (trace) observer.start = [&](Simulation& simulation) { trace->attach(scene, simulation); };
  RunResult result;
  try {
    ProgressBar bar(quiet, "", done);
    observer.progress = [&](std::int64_t step, std::int64_t steps) { bar.update(step, steps); };
    result = run(scene, stepping, observer, resumed ? &begin.point : nullptr);
  } catch (const InvalidRun& invalid) {
    trace.reset();  // ends it as far as that is possible
    folder.keep_invalid(last_valid, invalid.what());
    throw;
  }
  if (trace) trace->close();
  tell(std::span(result.warnings).subspan(warnings.size()));
  try {
    if (result.stopped) check_interruption();
  } catch (const Interrupted& signal) {
    say_stopped(
        signal,
        " after step " + std::to_string(result.steps) + " of " + std::to_string(stepping.steps) +
            (checkpoints && checkpoints->written() > 0
                 ? ": --resume " + where + " goes on from step " + std::to_string(checkpoints->written())
                 : std::string(", and nothing is left of it (--checkpoint keeps what was done)")));
    return signal.exit_code();
  }

  // 2. They are published as they are.
  const double seconds = clock.seconds();
  std::optional<ErrorReport> errors;
  std::string no_errors_because = "the reference solution was not computed to its end";
  RunReport report{scene, stepping, result, errors, no_errors_because};
  report.verdict = verdict_of(scene, result, errors, no_errors_because, motion);
  folder.write("scene.toml", scene_text(scene));
  folder.write("run.json", run_json(report));
  folder.write("timing.json", timing_json(result, seconds));
  folder.publish(begin.keep);

  // 3. The reference solution, and what it says.
  const Stopwatch reference_clock;
  try {
    const bool more = begin.errors == "full" && (given.has("errors") || !given.has("check"));
    const Budget budget{begin.errors, seconds, reference_budget(scene, stepping, more)};
    errors = errors_of(scene, result, motion, budget, quiet, no_errors_because);
  } catch (const Interrupted& signal) {
    say_stopped(signal, " while errors were computed; the run in " + where + " is complete without them");
    return signal.exit_code();
  }
  report.verdict = verdict_of(scene, result, errors, no_errors_because, motion);
  const std::string json = run_json(report);
  folder.replace("run.json", json);
  folder.replace(
      "timing.json",
      timing_json(result, seconds, errors ? std::optional(reference_clock.seconds()) : std::nullopt));

  if (!quiet) {
    if (given.has("json"))
      std::cout << json;
    else
      std::cout << run_summary(report) << "  files     " << where << "\n  verdict   " << report.verdict.text
                << "\n";
  }
  int code = success;
  if (given.has("check"))
    code = check_against(given.text("check"), folder.path(), quiet || given.has("json"));
  std::istringstream missed(unmet(scene, errors, report.verdict));
  for (std::string line; std::getline(missed, line); code = different)
    std::cerr << "hompm-run: " << line << '\n';
  return code;
}

}  // namespace hompm::cli
