#include "scene_run.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include <hompm/error.hpp>
#include <hompm/number.hpp>
#include <hompm/output/run_folder.hpp>
#include <hompm/output/run_report.hpp>
#include <hompm/recorder/checkpoint_writer.hpp>
#include <hompm/recorder/trace.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/simulation/warnings.hpp>
#include <hompm/verify/compare.hpp>

#include "common.hpp"
#include "comparison_text.hpp"
#include "interruption.hpp"
#include "listing.hpp"
#include "memory.hpp"
#include "progress.hpp"

namespace hompm::cli {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

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

fs::path output_folder(const po::variables_map& given, const Scene& scene) {
  if (given.count("output")) return given["output"].as<std::string>();
  if (given.count("resume")) return checkpoint_folder(given["resume"].as<std::string>());
  std::string name = scene.case_name;
  if (!scene.variant.empty()) name += "-" + scene.variant;
  return fs::path("hompm-out") / (name + "-" + scene.scheme.name);
}

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
  const Comparison comparison = compare_folders(folder, golden, {});
  const bool same = comparison.verdict == Verdict::identical;
  if (!quiet || !same)
    (quiet ? std::cerr : std::cout) << "  golden    " << golden.string() << ": "
                                    << comparison_text(comparison);
  return same ? success : different;
}

/// How a run begins: anew, or where the checkpoint `from` was written.
Checkpoint starting_point(const Scene& scene, const po::variables_map& given,
                          std::optional<Checkpoint> from) {
  Checkpoint point = from ? std::move(*from) : first_checkpoint(scene);
  point.scene = scene;
  point.vtk = point.vtk && given.count("no-vtk") == 0;
  if (given.count("checkpoint"))
    point.every = parse_steps(given["checkpoint"].as<std::string>(), "--checkpoint", 1);
  point.keep = point.keep || given.count("keep-checkpoint") > 0;
  if (given.count("errors")) {
    point.errors = given["errors"].as<std::string>();
    if (point.errors != "auto" && point.errors != "full" && point.errors != "none")
      throw UsageError("--errors " + point.errors + ": there are auto, full, none" +
                       suggestion(point.errors, {"auto", "full", "none"}));
  } else if (given.count("check")) {
    point.errors = "full";
  }
  return point;
}

/// The trace that --trace asks for; nothing without.
std::unique_ptr<Trace> asked_trace(const po::variables_map& given) {
  TraceOptions options;
  if (given.count("trace-values")) {
    if (!given.count("trace")) throw UsageError("--trace-values goes with --trace");
    options.values_from = parse_steps(given["trace-values"].as<std::string>(), "--trace-values", 0);
  }
  if (!given.count("trace")) return nullptr;
  return std::make_unique<Trace>(given["trace"].as<std::string>(), options);
}

void say_stopped(const Interrupted& signal, const std::string& rest) {
  std::cerr << "hompm-run: stopped by " << signal.name() << rest << std::endl;
}

struct BudgetUsedUp {};

/// Errors against the reference solution as far as they are asked for; `reason` says why there are none.
/// Throws `Interrupted`.
std::optional<ErrorReport> errors_of(const Scene& scene, const RunResult& result, const std::string& asked,
                                     double budget, bool quiet, std::string& reason) {
  if (asked == "none") {
    reason = "--errors none was given";
    return std::nullopt;
  }
  const Stopwatch clock;
  ProgressBar bar(quiet, "errors ");
  const auto watch = [&](double part) {
    check_interruption();
    if (asked == "auto" && clock.seconds() > budget) throw BudgetUsedUp();
    constexpr double parts = 1e6;
    bar.update(static_cast<std::int64_t>(parts * part), static_cast<std::int64_t>(parts));
  };
  try {
    return judge(scene, result, reason, watch);
  } catch (const BudgetUsedUp&) {
    reason = "the reference solution takes longer than the run; --errors full computes it all the same";
    return std::nullopt;
  }
}

}  // namespace

int run_scene(Scene scene, const po::variables_map& given, std::optional<Checkpoint> from) {
  const bool quiet = given.count("quiet") > 0;
  const bool resumed = from.has_value();
  demand_memory(scene, {.checkpoints = given.count("checkpoint") > 0 || given.count("keep-checkpoint") > 0,
                        .trace = given.count("trace") > 0});
  const auto form = given.count("json") > 0 ? Form::json : Form::text;
  if (given.count("critical-step")) {
    std::cout << critical_steps(scene, form);
    return success;
  }
  const TimeStepping stepping =
      resumed ? resumed_stepping(scene, from->point.states.front().time_step) : time_stepping(scene);
  const Checkpoint begin = starting_point(scene, given, std::move(from));
  const std::int64_t done = begin.point.states.front().step;
  if (resumed && done >= stepping.steps)
    throw CheckpointError("cannot resume from " + given["resume"].as<std::string>() +
                          ": the run has come to its end, t = " + to_text(scene.end_time) +
                          " s; --end-time asks for a later one");
  if (given.count("explain")) {
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
  if (given.count("no-clobber")) demand_no_run(folder, resumed);
  const auto trace = asked_trace(given);
  const Stopwatch clock(begin.seconds);
  std::optional<CheckpointWriter> checkpoints;
  if (begin.every > 0 || begin.keep) checkpoints.emplace(folder, begin, warn);
  if (!resumed && !quiet && fs::exists(folder.path() / checkpoint_name))
    warn("the run that was stopped in " + where + " is replaced (--resume " + where +
         " would go on with it)");
  for (const auto& row : begin.history) folder.write(row);
  for (const auto& snapshot : begin.snapshots) folder.write(snapshot);
  Snapshot last_valid = begin.snapshots.empty() ? Snapshot{} : begin.snapshots.back();

  RunObserver observer;
  observer.snapshot = [&](const Snapshot& snapshot) {
    folder.write(snapshot);
    if (checkpoints) checkpoints->keep(snapshot);
    last_valid = snapshot;
  };
  observer.history = [&](const HistoryRow& row) {
    folder.write(row);
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
  const RunReport report{scene, stepping, result, errors, no_errors_because};
  folder.write("scene.toml", scene_text(scene));
  folder.write("run.json", run_json(report));
  folder.write("timing.json", timing_json(result, seconds));
  folder.publish(begin.keep);

  // 3. The reference solution, and what it says.
  constexpr double least_budget = 2.0;  // s
  const Stopwatch reference_clock;
  try {
    errors =
        errors_of(scene, result, begin.errors, std::max(seconds, least_budget), quiet, no_errors_because);
  } catch (const Interrupted& signal) {
    say_stopped(signal, " while errors were computed; the run in " + where + " is complete without them");
    return signal.exit_code();
  }
  const std::string json = run_json(report);
  folder.replace("run.json", json);
  folder.replace(
      "timing.json",
      timing_json(result, seconds, errors ? std::optional(reference_clock.seconds()) : std::nullopt));

  if (!quiet) {
    if (given.count("json"))
      std::cout << json;
    else
      std::cout << run_summary(report) << "  files     " << where << "\n";
  }
  if (given.count("check"))
    return check_against(given["check"].as<std::string>(), folder.path(), quiet || given.count("json"));
  return success;
}

}  // namespace hompm::cli
