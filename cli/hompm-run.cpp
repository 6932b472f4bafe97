// hompm-run: runs one scene and says how good the result is.
//
// Reads a scene (built in, or a file), applies what the command line says about it, runs it, writes the
// output folder, and prints errors against the reference solution and the balances. With --check the scene of
// a golden folder is run and the result compared with it. Sample runs: below, in the topics of --help.
#include <iostream>
#include <optional>
#include <utility>

#include "interruption.hpp"
#include "listing.hpp"
#include "run_picture.hpp"
#include "scene_run.hpp"

namespace hompm::cli {
namespace {

Tool this_tool() {
  return {
      .name = "hompm-run",
      .usage = "--case NAME|--scene FILE|--check DIR|--resume FILE [options]",
      .about = "Runs a scene by the material point method and says how good the result is.",
      .examples = {"hompm-run --case column", "hompm-run --case bar --scheme bspline --cells 128",
                   "hompm-run --scene my.toml --set material.youngs_modulus=2e5 --output out"},
      .topics =
          {{"scenes",
            "what is simulated",
            {"hompm-run --case column --variant settled", "hompm-run --scene my.toml --end-time 2"},
            scene_options({{"list", "", "print cases, schemes, materials and effects"},
                           {"keys", "", "print every key of a scene: unit, range, default, meaning"}})},
           {"accuracy",
            "how it is discretised; hompm-study says which setting is the cheapest for an error",
            {"hompm-run --case bar --scheme high-order --degree 4 --cells 32",
             "hompm-run --case column --step-fraction 0.9"},
            {{"scheme", "NAME", "scheme.name; of the file stays what suits the scheme"},
             {"degree", "P", "scheme.degree"},
             {"cells", "N", "scheme.cells, over the length of the body"},
             {"particles-per-cell", "K", "scheme.particles_per_cell"},
             {"time-step", "S", "scheme.time_step, s"},
             {"courant", "C", "scheme.courant, c dt/h"},
             {"step-fraction", "R", "scheme.step_fraction, time step over the critical one"},
             {"require", "FIELD=BOUND...",
              "exit code 3 unless the relative error of displacement, velocity or stress is known to be this "
              "at "
              "most; as [require] in a scene"},
             {"critical-step", "", "print the critical time step, and run nothing"},
             {"explain", "", "print the stages of a step and what called for each, and run nothing"}}},
           {"outputs",
            "what is written and printed",
            {"hompm-run --case bar --output out --snapshots 50", "hompm-run --case bar --json",
             "hompm-run --case column --picture column.svg",
             "hompm-run --picture both.pdf out-bspline out-high-order"},
            {{"output", "DIR", "output folder (default hompm-out/CASE-VARIANT-SCHEME-pDEGREE-CELLS)"},
             {"snapshots", "N", "output.snapshots, after the start"},
             {"probe", "WHERE...",
              "add a [[probe]], for probes.csv: X in m, an end (left, right), or x=PLACE"},
             {"no-clobber", "", "refuse to replace a run that is in the output folder"},
             {"no-vtk", "", "write no vtk files"},
             {"errors", "WHICH",
              "errors against the reference solution: auto, unless it takes longer than the run and 2 s, or "
              "where "
              "runs of a better scheme make it a fifth of the run (default); full, however long it takes, "
              "such "
              "runs ten times the run (default with --check); none"},
             {"picture", "FILE",
              "draw the run: .svg, .png or .pdf, by gnuplot; behind FILE names of folders draw the runs that "
              "are there instead of a new one"},
             {"picture-xt", "FILE",
              "draw stress and velocity over X and time, of 200 snapshots unless --snapshots is given"},
             {"quiet", "", "print nothing but errors"}}},
           {"comparison",
            "with golden data, or of two builds stage by stage",
            {"hompm-run --check golden/bar-large-bspline", "hompm-run --case column --trace mine.trace",
             "hompm-run --case bar --dump-steps 3"},
            {{"check", "DIR", "compare with a golden folder; its scene is run when none is named"},
             {"trace", "FILE", "write a hash of every field after every stage, for hompm-diff --trace"},
             {"dump-steps", "N",
              "write steps.csv: all values of every field after each stage of the first N steps"},
             {"trace-values", "STEP", "with --trace: write all values from step STEP (default 0) on, too"}}},
           {"restart",
            "of a run that was stopped",
            {"hompm-run --case bar --checkpoint 1000 --output out", "hompm-run --resume out"},
            {{"checkpoint", "EVERY", "write checkpoint.hompm into the output folder every EVERY steps"},
             {"keep-checkpoint", "",
              "write one at the end, too, and keep it: --resume with a later --end-time"},
             {"resume", "FILE", "go on from a checkpoint, in its folder unless --output is given"}}}},
      .remarks =
          "Exit codes: 0 fine, 2 bad usage or scene, 3 differs from golden or is not as\n"
          "good as --require asks, 4 the run became invalid, 5 cannot read or write,\n"
          "6 this build or process does not compute as IEEE 754 says, 128 + n stopped by\n"
          "signal n.\n",
      .takes_arguments = true};
}

int run(const CommandLine& given) {
  if (given.has("list") || given.has("keys")) {
    const auto form = given.has("json") ? Form::json : Form::text;
    std::cout << (given.has("list") ? catalogue(form) : key_reference(form));
    return success;
  }
  check_picture_options(given);
  if (!given.arguments.empty()) return draw_runs(given, given.arguments) ? success : bad_file;
  std::optional<Checkpoint> from;
  if (given.has("resume")) from = read_checkpoint(given.text("resume"));
  Scene scene = from ? resumed_scene(given, *from) : scene_of(given);
  if (given.has("check")) demand_same_scene(scene, given);
  const std::string folder = output_folder(given, scene);
  const int code = run_scene(std::move(scene), given, std::move(from));
  const bool ran =
      (code == success || code == different) && !given.has("critical-step") && !given.has("explain");
  if (ran && (given.has("picture") || given.has("picture-xt"))) draw_runs(given, {folder});
  return code;
}

}  // namespace
}  // namespace hompm::cli

int main(int argc, char** argv) {
  using namespace hompm::cli;
  catch_interruption("hompm-run");
  return run_tool(this_tool(), argc, argv, run);
}
