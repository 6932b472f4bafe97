// hompm-run: runs one scene and says how good the result is.
//
// Sample runs:   hompm-run --case column
//                hompm-run --case bar --variant large --scheme bspline --cells 128
//                hompm-run --scene my.toml --set material.youngs_modulus=2e5 --output out
//                hompm-run --check golden/column-large-tielen2017
//
// Description:   Reads a scene (built in, or a file), applies what the command line says about it, runs it,
// writes the
//                output folder, and prints errors against the reference solution and the balances. With
//                --check the scene of a golden folder is run and the result compared with it.
#include <chrono>
#include <filesystem>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <boost/program_options.hpp>

#include <hompm/error.hpp>
#include <hompm/number.hpp>
#include <hompm/output/run_folder.hpp>
#include <hompm/output/run_report.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/simulation/run.hpp>
#include <hompm/verify/compare.hpp>

#include "common.hpp"
#include "comparison_text.hpp"
#include "listing.hpp"
#include "progress.hpp"

namespace {

using hompm::cli::UsageError;
namespace fs = std::filesystem;
namespace po = boost::program_options;

/// Options that are short for `--set KEY=VALUE`.
const std::vector<std::pair<std::string, std::string>> shortcuts{
    {"scheme", "scheme.name"},
    {"degree", "scheme.degree"},
    {"cells", "scheme.cells"},
    {"particles-per-cell", "scheme.particles_per_cell"},
    {"time-step", "scheme.time_step"},
    {"courant", "scheme.courant"},
    {"step-fraction", "scheme.step_fraction"},
    {"end-time", "end_time"},
    {"snapshots", "output.snapshots"},
};

po::options_description make_options() {
  po::options_description options("options");
  const auto text = [](const char* name) { return po::value<std::string>()->value_name(name); };
  options.add_options()("case", text("NAME"), "built-in case: bar, column")(
      "scene", text("FILE"), "scene file instead of a case")("variant", text("NAME"), "variant of the case")(
      "scheme", text("NAME"), "scheme.name; the scheme's own degree unless --degree is given")(
      "degree", text("P"), "scheme.degree")("cells", text("N"), "scheme.cells, over the length of the body")(
      "particles-per-cell", text("K"), "scheme.particles_per_cell")(
      "time-step", text("S"), "scheme.time_step, s")("courant", text("C"), "scheme.courant, c dt/h")(
      "step-fraction", text("R"), "scheme.step_fraction, time step over the critical one")(
      "end-time", text("S"), "end_time, s")(
      "set", po::value<std::vector<std::string>>()->composing()->value_name("KEY=VALUE"),
      "set any key of the scene")("snapshots", text("N"), "output.snapshots, after the start")(
      "output", text("DIR"), "output folder (default hompm-out/CASE-VARIANT-SCHEME)")(
      "no-vtk", "write no vtk files")("check", text("DIR"),
                                      "compare with a golden folder; its scene is run when none is named")(
      "explain", "print the stages of a step and what called for each, and run nothing")(
      "json", "print run.json instead of the summary")("quiet", "print nothing but errors")(
      "list", "list cases, schemes, materials and effects")("version", "print the version")("help",
                                                                                            "print this");
  return options;
}

std::string usage_text(const po::options_description& options) {
  std::ostringstream text;
  text << "usage: hompm-run --case NAME [options]\n"
          "       hompm-run --scene FILE [options]\n"
          "       hompm-run --check GOLDEN [options]\n\n"
          "Runs a scene by the material point method and says how good the result is.\n\n"
       << options
       << "\nExit codes: 0 fine, 2 bad usage or scene, 3 differs from golden, 4 the run became invalid,\n"
          "5 cannot read or write.\n";
  return text.str();
}

std::vector<hompm::Override> overrides_of(const po::variables_map& given) {
  std::vector<hompm::Override> overrides;
  for (const auto& [option, key] : shortcuts)
    if (given.count(option)) {
      const auto& value = given[option].as<std::string>();
      overrides.push_back({key, value, std::string("--").append(option).append(" ").append(value)});
    }
  if (given.count("set"))
    for (const auto& text : given["set"].as<std::vector<std::string>>()) {
      const auto equals = text.find('=');
      if (equals == std::string::npos || equals == 0)
        throw UsageError("--set " + text + ": expected KEY=VALUE, as in --set scheme.cells=32");
      overrides.push_back({text.substr(0, equals), text.substr(equals + 1), "--set " + text});
    }
  return overrides;
}

/// The scene that is asked for: a case, a file, or that of a golden folder.
hompm::Scene scene_of(const po::variables_map& given) {
  auto overrides = overrides_of(given);
  const auto text = [&](const char* option) {
    return given.count(option) ? given[option].as<std::string>() : std::string();
  };
  if (given.count("case") && given.count("scene")) throw UsageError("--case and --scene exclude each other");
  if (given.count("variant") && !given.count("case")) throw UsageError("--variant goes with --case");
  if (given.count("scene")) return hompm::load_scene(text("scene"), overrides);
  if (given.count("case")) return hompm::load_builtin(text("case"), text("variant"), overrides);
  if (given.count("check")) return hompm::load_scene(fs::path(text("check")) / "scene.toml", overrides);
  throw UsageError(
      "nothing to run: name a --case (bar, column), a --scene FILE, or a golden folder to --check");
}

/// "here `cells = 64`, there `cells = 32`", for the first line in which two texts differ.
std::string first_different_line(const std::string& here, const std::string& there) {
  std::istringstream a(here);
  std::istringstream b(there);
  std::string line_a;
  std::string line_b;
  do {
    if (!std::getline(a, line_a)) line_a = "nothing more";
    if (!std::getline(b, line_b)) line_b = "nothing more";
  } while (line_a == line_b);
  return "here `" + line_a + "`, there `" + line_b + "`";
}

/// How often to write is not part of what is simulated: it follows the golden scene unless the command line
/// says otherwise.
void demand_same_scene(hompm::Scene& scene, const po::variables_map& given) {
  const std::string folder = given["check"].as<std::string>();
  const hompm::Scene golden = hompm::load_scene(fs::path(folder) / "scene.toml", {});
  if (!given.count("snapshots") && scene.origins.count("output.snapshots") == 0) scene.output = golden.output;
  const std::string mine = hompm::scene_text(scene);
  const std::string theirs = hompm::scene_text(golden);
  if (mine == theirs) return;
  throw UsageError("--check " + folder +
                   ": a golden of another scene: " + first_different_line(mine, theirs));
}

fs::path output_folder(const po::variables_map& given, const hompm::Scene& scene) {
  if (given.count("output")) return given["output"].as<std::string>();
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

/// Runs the scene into its folder. A run that becomes invalid leaves its last valid snapshot, marked as such.
int run_scene(const hompm::Scene& scene, const po::variables_map& given) {
  const bool quiet = given.count("quiet") > 0;
  const hompm::TimeStepping stepping = hompm::time_stepping(scene);
  if (given.count("explain")) {
    std::cout << hompm::cli::plan_text(scene, stepping);
    return hompm::cli::success;
  }
  hompm::RunFolder folder(output_folder(given, scene), given.count("no-vtk") == 0);

  const auto start = std::chrono::steady_clock::now();
  std::optional<hompm::RunResult> result;
  hompm::Snapshot last_valid;
  try {
    hompm::cli::ProgressBar bar(quiet);
    result =
        hompm::run(scene, stepping,
                   {.snapshot =
                        [&](const hompm::Snapshot& snapshot) {
                          folder.write(snapshot);
                          last_valid = snapshot;
                        },
                    .history = [&](const hompm::HistoryRow& row) { folder.write(row); },
                    .progress = [&](std::int64_t step, std::int64_t steps) { bar.update(step, steps); }});
  } catch (const hompm::InvalidRun& invalid) {
    folder.keep_invalid(last_valid, invalid.what());
    throw;
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  std::string no_errors_because;
  const auto errors = hompm::judge(scene, *result, no_errors_because);
  const hompm::RunReport report{scene, stepping, *result, errors, no_errors_because};
  const std::string json = hompm::run_json(report);
  folder.write("scene.toml", hompm::scene_text(scene));
  folder.write("run.json", json);
  folder.write("timing.json", hompm::timing_json(*result, seconds));
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

int run_tool(int argc, char** argv) {
  const auto options = make_options();
  if (argc < 2) {
    std::cerr << usage_text(options);
    return hompm::cli::usage;
  }
  const auto [given, arguments] = hompm::cli::read_command_line(argc, argv, options);
  if (!arguments.empty()) throw UsageError("`" + arguments.front() + "` is not an option");
  if (given.count("help")) {
    std::cout << usage_text(options);
    return hompm::cli::success;
  }
  if (given.count("version")) {
    std::cout << hompm::cli::version_text("hompm-run") << '\n';
    return hompm::cli::success;
  }
  if (given.count("list")) {
    std::cout << hompm::cli::catalogue_text();
    return hompm::cli::success;
  }
  hompm::Scene scene = scene_of(given);
  if (given.count("check")) demand_same_scene(scene, given);
  return run_scene(scene, given);
}

}  // namespace

int main(int argc, char** argv) {
  return hompm::cli::run_tool("hompm-run", [&] { return run_tool(argc, argv); });
}
