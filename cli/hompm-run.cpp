// hompm-run: runs one scene and says how good the result is.
//
// Reads a scene (built in, or a file), applies what the command line says about it, runs it, writes the
// output folder, and prints errors against the reference solution and the balances. With --check the scene of
// a golden folder is run and the result compared with it. Sample runs: below, in the topics of --help.
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <boost/program_options.hpp>

#include <hompm/error.hpp>
#include <hompm/number.hpp>
#include <hompm/output/run_folder.hpp>
#include <hompm/output/run_report.hpp>
#include <hompm/recorder/checkpoint_writer.hpp>
#include <hompm/recorder/trace.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/simulation/caution.hpp>
#include <hompm/simulation/run.hpp>
#include <hompm/verify/compare.hpp>

#include "common.hpp"
#include "comparison_text.hpp"
#include "listing.hpp"
#include "progress.hpp"
#include "scene_choice.hpp"

namespace {

using hompm::cli::UsageError;
namespace fs = std::filesystem;
namespace po = boost::program_options;

hompm::cli::Tool this_tool() {
  return {
      .name = "hompm-run",
      .usage = "--case NAME | --scene FILE | --check DIR | --resume FILE [options]",
      .about = "Runs a scene by the material point method and says how good the result is.",
      .examples = {"hompm-run --case column", "hompm-run --case bar --scheme bspline --cells 128",
                   "hompm-run --scene my.toml --set material.youngs_modulus=2e5 --output out"},
      .topics =
          {{"scenes",
            "what is simulated",
            {"hompm-run --case column --variant settled", "hompm-run --scene my.toml --end-time 2"},
            {{"case", "NAME", "built-in case: bar, column"},
             {"variant", "NAME", "variant of the case"},
             {"scene", "FILE", "scene file instead of a case"},
             {"set", "KEY=VALUE...", "set any key of the scene"},
             {"end-time", "S", "end_time, s"},
             {"list", "", "print cases, schemes, materials and effects"},
             {"keys", "", "print every key of a scene: unit, range, default, meaning"}}},
           {"accuracy",
            "how it is discretised; hompm-study says which setting is the cheapest for an error",
            {"hompm-run --case bar --scheme high-order --degree 4 --cells 32",
             "hompm-run --case column --step-fraction 0.9"},
            {{"scheme", "NAME", "scheme.name; the scheme's own degree unless --degree is given"},
             {"degree", "P", "scheme.degree"},
             {"cells", "N", "scheme.cells, over the length of the body"},
             {"particles-per-cell", "K", "scheme.particles_per_cell"},
             {"time-step", "S", "scheme.time_step, s"},
             {"courant", "C", "scheme.courant, c dt/h"},
             {"step-fraction", "R", "scheme.step_fraction, time step over the critical one"},
             {"critical-step", "", "print the critical time step, and run nothing"},
             {"explain", "", "print the stages of a step and what called for each, and run nothing"}}},
           {"outputs",
            "what is written and printed",
            {"hompm-run --case bar --output out --snapshots 50", "hompm-run --case bar --json"},
            {{"output", "DIR", "output folder (default hompm-out/CASE-VARIANT-SCHEME)"},
             {"snapshots", "N", "output.snapshots, after the start"},
             {"no-vtk", "", "write no vtk files"},
             {"quiet", "", "print nothing but errors"}}},
           {"comparison",
            "with golden data, or of two builds stage by stage",
            {"hompm-run --check golden/bar-large-bspline", "hompm-run --case column --trace mine.trace"},
            {{"check", "DIR", "compare with a golden folder; its scene is run when none is named"},
             {"trace", "FILE", "write a hash of every field after every stage, for hompm-diff --trace"},
             {"trace-values", "STEP", "with --trace: write all values from step STEP (default 0) on, too"}}},
           {"restart",
            "of a run that was stopped",
            {"hompm-run --case bar --checkpoint 1000 --output out", "hompm-run --resume out"},
            {{"checkpoint", "EVERY", "write checkpoint.hompm into the output folder every EVERY steps"},
             {"resume", "FILE", "go on from a checkpoint, in its folder unless --output is given"}}}},
      .remarks =
          "Exit codes: 0 fine, 2 bad usage or scene, 3 differs from golden, 4 the run became\n"
          "invalid, 5 cannot read or write, 6 this build or process does not compute as\n"
          "IEEE 754 says.\n"};
}

fs::path output_folder(const po::variables_map& given, const hompm::Scene& scene) {
  if (given.count("output")) return given["output"].as<std::string>();
  if (given.count("resume")) return hompm::checkpoint_folder(given["resume"].as<std::string>());
  std::string name = scene.case_name;
  if (!scene.variant.empty()) name += "-" + scene.variant;
  return fs::path("hompm-out") / (name + "-" + scene.scheme.name);
}

int check_against(const fs::path& golden, const fs::path& folder, bool quiet) {
  const hompm::Comparison comparison = hompm::compare_folders(folder, golden, {});
  const bool same = comparison.verdict == hompm::Verdict::identical;
  if (!quiet || !same)
    (quiet ? std::cerr : std::cout) << "  golden    " << golden.string() << ": "
                                    << hompm::cli::comparison_text(comparison);
  return same ? hompm::cli::success : hompm::cli::different;
}

/// How a run begins: anew, or where the checkpoint `from` was written.
hompm::Checkpoint starting_point(const hompm::Scene& scene, const po::variables_map& given,
                                 std::optional<hompm::Checkpoint> from) {
  hompm::Checkpoint point = from ? std::move(*from) : hompm::first_checkpoint(scene);
  point.scene = scene;
  point.vtk = point.vtk && given.count("no-vtk") == 0;
  if (given.count("checkpoint"))
    point.every = hompm::cli::parse_steps(given["checkpoint"].as<std::string>(), "--checkpoint", 1);
  return point;
}

/// The trace that --trace asks for; nothing without.
std::unique_ptr<hompm::Trace> open_trace(const po::variables_map& given) {
  hompm::TraceOptions options;
  if (given.count("trace-values")) {
    if (!given.count("trace")) throw UsageError("--trace-values goes with --trace");
    options.values_from =
        hompm::cli::parse_steps(given["trace-values"].as<std::string>(), "--trace-values", 0);
  }
  if (!given.count("trace")) return nullptr;
  return std::make_unique<hompm::Trace>(given["trace"].as<std::string>(), options);
}

/// Runs the scene into its folder. A run that becomes invalid leaves its last valid snapshot, marked as such.
int run_scene(const hompm::Scene& scene, const po::variables_map& given,
              std::optional<hompm::Checkpoint> from) {
  const bool quiet = given.count("quiet") > 0;
  const bool resumed = from.has_value();
  const auto form = given.count("json") > 0 ? hompm::cli::Form::json : hompm::cli::Form::text;
  if (given.count("critical-step")) {
    std::cout << hompm::cli::critical_steps(scene, form);
    return hompm::cli::success;
  }
  const hompm::TimeStepping stepping = hompm::time_stepping(scene);
  const hompm::Checkpoint begin = starting_point(scene, given, std::move(from));
  if (given.count("explain")) {
    std::cout << hompm::cli::explanation(scene, stepping, form);
    return hompm::cli::success;
  }
  if (const std::string caution = hompm::caution(scene); !quiet && !caution.empty())
    hompm::cli::warn(caution);
  hompm::RunFolder folder(output_folder(given, scene), begin.vtk, !scene.bodies.empty());
  const auto trace = open_trace(given);
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return begin.seconds + std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  std::optional<hompm::CheckpointWriter> checkpoints;
  if (begin.every > 0) checkpoints.emplace(folder, begin, hompm::cli::warn);
  if (!resumed && !quiet && fs::exists(folder.path() / hompm::checkpoint_name))
    hompm::cli::warn("the run that was stopped in " + folder.path().string() + " is replaced (--resume " +
                     folder.path().string() + " would go on with it)");
  for (const auto& row : begin.history) folder.write(row);
  for (const auto& snapshot : begin.snapshots) folder.write(snapshot);
  hompm::Snapshot last_valid = begin.snapshots.empty() ? hompm::Snapshot{} : begin.snapshots.back();

  hompm::RunObserver observer;
  observer.snapshot = [&](const hompm::Snapshot& snapshot) {
    folder.write(snapshot);
    if (checkpoints) checkpoints->keep(snapshot);
    last_valid = snapshot;
  };
  observer.history = [&](const hompm::HistoryRow& row) {
    folder.write(row);
    if (checkpoints) checkpoints->keep(row);
  };
  observer.checkpoint = [&](const hompm::RunPoint& point) { checkpoints->write(point, seconds()); };
  observer.checkpoint_every = begin.every;
  if (trace) observer.start = [&](hompm::Simulation& simulation) { trace->attach(scene, simulation); };
  std::optional<hompm::RunResult> result;
  try {
    hompm::cli::ProgressBar bar(quiet);
    observer.progress = [&](std::int64_t step, std::int64_t steps) { bar.update(step, steps); };
    result = hompm::run(scene, stepping, observer, resumed ? &begin.point : nullptr);
  } catch (const hompm::InvalidRun& invalid) {
    folder.keep_invalid(last_valid, invalid.what());
    throw;
  }
  if (trace) trace->close();

  std::string no_errors_because;
  const auto errors = hompm::judge(scene, *result, no_errors_because);
  const hompm::RunReport report{scene, stepping, *result, errors, no_errors_because};
  const std::string json = hompm::run_json(report);
  folder.write("scene.toml", hompm::scene_text(scene));
  folder.write("run.json", json);
  folder.write("timing.json", hompm::timing_json(*result, seconds()));
  folder.publish();

  if (!quiet) {
    if (given.count("json"))
      std::cout << json;
    else
      std::cout << hompm::run_summary(report) << "  files     " << folder.path().string() << "\n";
  }
  if (given.count("check"))
    return check_against(given["check"].as<std::string>(), folder.path(), quiet || given.count("json"));
  return hompm::cli::success;
}

int run(const po::variables_map& given) {
  if (given.count("list") || given.count("keys")) {
    const auto form = given.count("json") > 0 ? hompm::cli::Form::json : hompm::cli::Form::text;
    std::cout << (given.count("list") ? hompm::cli::catalogue(form) : hompm::cli::key_reference(form));
    return hompm::cli::success;
  }
  std::optional<hompm::Checkpoint> from;
  if (given.count("resume")) from = hompm::read_checkpoint(given["resume"].as<std::string>());
  hompm::Scene scene = from && !hompm::cli::names_scene(given) ? from->scene : hompm::cli::scene_of(given);
  if (given.count("check")) hompm::cli::demand_same_scene(scene, given);
  if (from) hompm::cli::demand_resumed_scene(scene, from->scene, given);
  return run_scene(scene, given, std::move(from));
}

}  // namespace

int main(int argc, char** argv) {
  return hompm::cli::run_tool(this_tool(), argc, argv,
                              [](const auto& command_line) { return run(command_line.options); });
}
