// hompm-study: what accuracy costs.
//
// Description:
//   Runs one scene with many settings, judges every run by the reference solution, counts what it costs, and
//   says which setting is the cheapest for an error. A study is a list of independent points; --list,
//   --point,
//   --times and --gather are its parts, for a workflow engine.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <hompm/kit/output/staging.hpp>
#include <hompm/kit/study/answers.hpp>
#include <hompm/kit/study/measure.hpp>
#include <hompm/numerics/floating_point.hpp>

#include "common.hpp"
#include "interruption.hpp"
#include "study_run.hpp"

namespace hompm::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Tool this_tool() {
  return {.name = "hompm-study",
          .usage = "--case NAME|--scene FILE|--study FILE [options]",
          .about = "Runs a scene with many settings and says which is the cheapest for an error.",
          .examples = {"hompm-study --case bar", "hompm-study --study my-study.toml --jobs 4",
                       "hompm-study --case bar --vary scheme,cells --vary courant=0.2,0.1"},
          .topics = {{"points",
                      "what is run",
                      {"hompm-study --case column --set end_time=0.5 --vary scheme,cells=8,16"},
                      {{"case", "NAME", "built-in case: bar, column"},
                       {"variant", "NAME", "variant of the case"},
                       {"scene", "FILE", "scene file instead of a case"},
                       {"study", "FILE", "study file instead of either"},
                       {"vary", "KEYS...",
                        "keys to vary: scheme,degree,cells or cells=8,16,32; every combination is run"},
                       {"set", "KEY=VALUE...", "set any key of the scene in every point"}}},
                     {"accuracy",
                      "which setting to use",
                      {"hompm-study --case bar --advise --error 1e-4"},
                      {{"advise", "", "print the setting to use for --error, no more"},
                       {"error", "E", "relative L2 error that is wanted"},
                       {"field", "NAME", "of displacement (default), velocity or stress"}}},
                     {"cost",
                      "how it is measured",
                      {},
                      {{"repeats", "N", "wall-clock times per point (default 5; 0 for none)"},
                       {"no-instructions", "", "count no instructions"},
                       {"jobs", "N", "points at a time (default: one per processor)"}}},
                     {"parts",
                      "of a study, for a workflow engine",
                      {"hompm-study --study my-study.toml --list"},
                      {{"list", "", "print the names of the points"},
                       {"point", "NAME", "run this point only"},
                       {"times", "", "only take times of the points that were run"},
                       {"gather", "", "only make tables and pictures anew"},
                       {"count", "DIR", "step from the states in DIR: what --point runs under callgrind"}}},
                     {"outputs",
                      "what is written and printed",
                      {},
                      {{"output", "DIR", "output folder (default hompm-out/study-CASE-VARIANT)"},
                       {"quiet", "", "print nothing but errors"}}}},
          .remarks =
              "Exit codes: 0 fine, 2 bad usage, scene or study, 4 no setting can be run or\n"
              "reaches the error, 5 cannot read or write, 128 + n stopped by signal n: the\n"
              "same command goes on.\n"};
}

study::Study study_of(const CommandLine& given) {
  const auto named = given.has("case") + given.has("scene") + given.has("study");
  if (named == 0)
    throw UsageError("nothing to study: name a --case (bar, column), a --scene or a --study file");
  if (named > 1) throw UsageError("--case, --scene and --study exclude each other");
  if (given.has("variant") && !given.has("case")) throw UsageError("--variant goes with --case");
  study::Study study;
  if (given.has("study"))
    study = study::read_study(given.text("study"));
  else
    study = {given.text("case"), given.text("variant"), given.text("scene")};
  for (const auto& text : given.texts("set")) {
    const auto [key, value] = key_and_value(text);
    const std::string where = "--set " + text;
    study.settings.push_back({study::full_key(key, where), study::canonical_value(value, where), where});
  }
  study::Sweep sweep;
  for (const auto& text : given.texts("vary"))
    for (study::Axis& axis : study::read_axes(text)) {
      if (std::ranges::find(sweep, axis.key, &study::Axis::key) != sweep.end())
        throw UsageError("--vary names " + study::short_key(axis.key) + " twice");
      sweep.push_back(std::move(axis));
    }
  if (!sweep.empty()) study.sweeps = {sweep};
  if (study.sweeps.empty()) study.sweeps = study::usual_sweeps();
  for (const auto& text : given.texts("set"))
    for (const study::Sweep& varied : study.sweeps)
      if (const auto key = study::full_key(key_and_value(text).first, text);
          std::ranges::find(varied, key, &study::Axis::key) != varied.end())
        throw UsageError("--set " + text + ": " + study::short_key(key) +
                         " is varied: leave one of them out");
  return study;
}

fs::path folder_of(const CommandLine& given, const study::Study& study) {
  if (given.has("output")) return given.text("output");
  const std::string file = given.has("study") ? given.text("study") : study.scene_file;
  const std::string name = study.case_name + (study.variant.empty() ? "" : "-" + study.variant);
  return fs::path("hompm-out") / ("study-" + (file.empty() ? name : fs::path(file).stem().string()));
}

unsigned workers_of(const CommandLine& given) {
  if (!given.has("jobs")) return std::max(1U, std::thread::hardware_concurrency());
  const auto jobs = parse_count(given.text("jobs"), "--jobs");
  if (jobs >= 1 && jobs <= 1024) return static_cast<unsigned>(jobs);
  throw UsageError("--jobs: from 1 to 1024, not " + given.text("jobs"));
}

int rounds_of(const CommandLine& given) {
  const auto rounds = given.has("repeats") ? parse_count(given.text("repeats"), "--repeats") : 5;
  if (rounds <= 1000) return static_cast<int>(rounds);
  throw UsageError("--repeats: at most 1000, not " + given.text("repeats"));
}

study::Field field_of(const CommandLine& given) {
  const std::string name = given.has("field") ? given.text("field") : "displacement";
  std::vector<std::string> names;
  for (const study::Field field : study::all_fields) {
    names.push_back(study::to_string(field));
    if (names.back() == name) return field;
  }
  throw UsageError("--field " + name + ": there are displacement, velocity, stress" +
                   suggestion(name, names));
}

double error_of(const CommandLine& given) {
  if (!given.has("error")) throw UsageError("--advise needs --error, the relative L2 error wanted");
  const double error = parse_number(given.text("error"), "--error");
  if (!(error > 0.0)) throw UsageError("--error must be greater than 0, not " + given.text("error"));
  return error;
}

const study::Point& point_called(const StudyJob& job, const std::string& name) {
  std::vector<std::string> names;
  for (const study::Point& point : job.points) {
    if (point.name == name) return point;
    names.push_back(point.name);
  }
  throw UsageError("the study has no point " + name + suggestion(name, names));
}

int advise(const StudyJob& job, study::Field field, double error, bool json) {
  const auto outcomes = gathered(job);
  const study::Cost cost = study::steady_cost(outcomes);
  const study::Choice choice = study::choice_of(outcomes, field, cost);
  const std::string answer = study::answer(outcomes, field, cost, error);
  const auto best = study::cheapest(choice.candidates, error);
  const std::string command = best ? study::command_text(job.study, *choice.outcomes[*best]) : "";
  if (json)
    std::cout << Json{{"answer", answer}, {"command", best ? Json(command) : Json()}}.dump(2) << '\n';
  else
    std::cout << answer << "\n" << command << (best ? "\n" : "");
  return best ? success : invalid_run;
}

int run_study(const StudyJob& job, const CommandLine& given) {
  const bool advice = given.has("advise");
  const int rounds = rounds_of(given);
  const unsigned workers = workers_of(given);
  const study::Field field = field_of(given);
  const double error = advice ? error_of(given) : 0.0;
  if (!advice && given.has("error")) throw UsageError("--error goes with --advise");
  if (job.instructions && !has_callgrind() && !job.quiet)
    std::cerr << "hompm-study: valgrind is not there, so no instructions are counted\n";
  detail::write_whole(job.folder / "study.toml", study::study_text(job.study));
  const HeldInterruption held;
  try {
    run_points(job, workers);
    if (!advice && rounds > 0) run_times(job, rounds);
  } catch (const Interrupted& signal) {
    std::cerr << "hompm-study: stopped by " << signal.name() << " with " << gathered_count(job) << " of "
              << job.points.size() << " points run; the same command goes on from there\n";
    return signal.exit_code();
  }
  if (advice) return advise(job, field, error, given.has("json"));
  return write_study_files(job);
}

int run(const CommandLine& given) {
  if (given.has("count")) {
    std::cout << "counted steps: " << study::step_from_moments(given.text("count")) << '\n';
    return success;
  }
  StudyJob job;
  job.study = study_of(given);
  job.points = study::checked_points(job.study);
  job.folder = folder_of(given, job.study);
  job.instructions = !given.has("no-instructions");
  job.quiet = given.has("quiet");
  if (given.has("list")) {
    Json names = Json::array();
    for (const study::Point& point : job.points) names.push_back(point.name);
    if (given.has("json"))
      std::cout << Json{{"points", names}}.dump(2) << '\n';
    else
      for (const study::Point& point : job.points) std::cout << point.name << '\n';
    return success;
  }
  numerics::check_floating_point();
  const bool in_parts = given.has("point") || given.has("times") || given.has("gather");
  if (!in_parts) return run_study(job, given);
  const HeldInterruption held;
  try {
    if (given.has("point")) run_point(job, point_called(job, given.text("point")));
    if (given.has("times")) run_times(job, rounds_of(given));
  } catch (const Interrupted& signal) {
    return signal.exit_code();
  }
  return given.has("gather") ? write_study_files(job) : success;
}

}  // namespace
}  // namespace hompm::cli

int main(int argc, char** argv) {
  using namespace hompm::cli;
  catch_interruption("hompm-study");
  return run_tool(this_tool(), argc, argv, run);
}
