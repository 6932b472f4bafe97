// hompm-study: what accuracy costs.
//
// Description:   Runs one scene with many settings, judges every run by the reference solution, counts what
// it
//                costs, and says which setting is the cheapest for an error. A study is a list of independent
//                points; --list, --point, --times and --gather are its parts, for a workflow engine.
#include <filesystem>
#include <iostream>
#include <string>
#include <thread>

#include <boost/program_options.hpp>
#include <nlohmann/json.hpp>

#include <hompm/error.hpp>
#include <hompm/numerics/floating_point.hpp>
#include <hompm/study/answers.hpp>
#include <hompm/study/measure.hpp>
#include <hompm/study/tables.hpp>

#include "callgrind.hpp"
#include "common.hpp"
#include "interruption.hpp"
#include "study_files.hpp"
#include "study_run.hpp"

namespace {

using hompm::cli::StudyJob;
using hompm::cli::UsageError;
namespace fs = std::filesystem;
namespace po = boost::program_options;
namespace study = hompm::study;
using Json = nlohmann::ordered_json;

hompm::cli::Tool this_tool() {
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

std::string text_option(const po::variables_map& given, const char* option) {
  return given.count(option) ? given[option].as<std::string>() : std::string();
}

study::Study study_of(const po::variables_map& given) {
  const auto named = given.count("case") + given.count("scene") + given.count("study");
  if (named == 0)
    throw UsageError("nothing to study: name a --case (bar, column), a --scene or a --study file");
  if (named > 1) throw UsageError("--case, --scene and --study exclude each other");
  if (given.count("variant") && !given.count("case")) throw UsageError("--variant goes with --case");
  study::Study study;
  if (given.count("study")) study = study::read_study(text_option(given, "study"));
  study.case_name = given.count("study") ? study.case_name : text_option(given, "case");
  study.variant = given.count("study") ? study.variant : text_option(given, "variant");
  if (given.count("scene")) study.scene_file = text_option(given, "scene");
  if (given.count("set"))
    for (const auto& text : given["set"].as<std::vector<std::string>>()) {
      const auto equals = text.find('=');
      const std::string where = "--set " + text;
      if (equals == std::string::npos || equals == 0)
        throw UsageError(where + ": expected KEY=VALUE, as in --set scheme.cells=32");
      study.settings.push_back({study::full_key(text.substr(0, equals), where),
                                study::canonical_value(text.substr(equals + 1), where)});
    }
  if (given.count("vary")) {
    study::Sweep sweep;
    for (const auto& text : given["vary"].as<std::vector<std::string>>())
      for (study::Axis& axis : study::read_axes(text)) {
        for (const study::Axis& other : sweep)
          if (other.key == axis.key)
            throw UsageError("--vary names " + study::short_key(axis.key) + " twice");
        sweep.push_back(std::move(axis));
      }
    study.sweeps = {sweep};
  }
  if (study.sweeps.empty()) study.sweeps = study::usual_sweeps();
  return study;
}

fs::path folder_of(const po::variables_map& given, const study::Study& study) {
  if (given.count("output")) return text_option(given, "output");
  if (given.count("study"))
    return fs::path("hompm-out") / ("study-" + fs::path(text_option(given, "study")).stem().string());
  if (given.count("scene"))
    return fs::path("hompm-out") / ("study-" + fs::path(study.scene_file).stem().string());
  return fs::path("hompm-out") /
         ("study-" + study.case_name + (study.variant.empty() ? "" : "-" + study.variant));
}

unsigned workers_of(const po::variables_map& given) {
  if (!given.count("jobs")) return std::max(1U, std::thread::hardware_concurrency());
  const auto jobs = hompm::cli::parse_count(text_option(given, "jobs"), "--jobs");
  if (jobs < 1 || jobs > 1024) throw UsageError("--jobs: from 1 to 1024, not " + text_option(given, "jobs"));
  return static_cast<unsigned>(jobs);
}

int rounds_of(const po::variables_map& given) {
  if (!given.count("repeats")) return 5;
  const auto rounds = hompm::cli::parse_count(text_option(given, "repeats"), "--repeats");
  if (rounds > 1000) throw UsageError("--repeats: at most 1000, not " + text_option(given, "repeats"));
  return static_cast<int>(rounds);
}

study::Field field_of(const po::variables_map& given) {
  const std::string name = given.count("field") ? text_option(given, "field") : "displacement";
  std::vector<std::string> names;
  for (const study::Field field : study::all_fields) {
    names.push_back(study::to_string(field));
    if (names.back() == name) return field;
  }
  throw UsageError("--field " + name + ": there are displacement, velocity, stress" +
                   hompm::cli::suggestion(name, names));
}

double error_of(const po::variables_map& given) {
  if (!given.count("error")) throw UsageError("--advise needs --error, the relative L2 error wanted");
  const double error = hompm::cli::parse_number(text_option(given, "error"), "--error");
  if (!(error > 0.0)) throw UsageError("--error must be greater than 0, not " + text_option(given, "error"));
  return error;
}

const study::Point& point_called(const StudyJob& job, const std::string& name) {
  std::vector<std::string> names;
  for (const study::Point& point : job.points) {
    if (point.name == name) return point;
    names.push_back(point.name);
  }
  throw UsageError("the study has no point " + name + hompm::cli::suggestion(name, names));
}

int advise(const StudyJob& job, study::Field field, double error, bool json) {
  auto gathered = hompm::cli::gathered(job);
  const study::Cost cost = study::steady_cost(gathered);
  const study::Choice choice = study::choice_of(gathered, field, cost);
  const std::string answer = study::answer(gathered, field, cost, error);
  const auto best = study::cheapest(choice.candidates, error);
  const std::string command = best ? study::command_text(job.study, *choice.outcomes[*best]) : "";
  if (json)
    std::cout << Json{{"answer", answer}, {"command", best ? Json(command) : Json()}}.dump(2) << '\n';
  else
    std::cout << answer << "\n" << command << (best ? "\n" : "");
  return best ? hompm::cli::success : hompm::cli::invalid_run;
}

int run_study(const StudyJob& job, const po::variables_map& given) {
  using namespace hompm::cli;
  const bool advice = given.count("advise") > 0;
  const int rounds = rounds_of(given);
  const unsigned workers = workers_of(given);
  const study::Field field = field_of(given);
  const double error = advice ? error_of(given) : 0.0;
  if (!advice && given.count("error")) throw UsageError("--error goes with --advise");
  if (job.instructions && !has_callgrind() && !job.quiet)
    std::cerr << "hompm-study: valgrind is not there, so no instructions are counted\n";
  study::write_whole(job.folder / "study.toml", study::study_text(job.study));
  const HeldInterruption held;
  try {
    run_points(job, workers);
    if (!advice && rounds > 0) run_times(job, rounds);
  } catch (const Interrupted& signal) {
    std::cerr << "hompm-study: stopped by " << signal.name() << " with " << gathered_count(job) << " of "
              << job.points.size() << " points run; the same command goes on from there\n";
    return signal.exit_code();
  }
  if (advice) return advise(job, field, error, given.count("json") > 0);
  return write_study_files(job);
}

int run(const po::variables_map& given) {
  if (given.count("count")) {
    std::cout << "counted steps: " << study::step_from_moments(text_option(given, "count")) << '\n';
    return hompm::cli::success;
  }
  StudyJob job;
  job.study = study_of(given);
  job.points = study::checked_points(job.study);
  job.folder = folder_of(given, job.study);
  job.instructions = !given.count("no-instructions");
  job.quiet = given.count("quiet") > 0;
  if (given.count("list")) {
    Json names = Json::array();
    for (const study::Point& point : job.points) names.push_back(point.name);
    if (given.count("json") > 0)
      std::cout << Json{{"points", names}}.dump(2) << '\n';
    else
      for (const study::Point& point : job.points) std::cout << point.name << '\n';
    return hompm::cli::success;
  }
  hompm::numerics::check_floating_point();
  const bool in_parts = given.count("point") || given.count("times") || given.count("gather");
  if (!in_parts) return run_study(job, given);
  const hompm::cli::HeldInterruption held;
  try {
    if (given.count("point")) hompm::cli::run_point(job, point_called(job, text_option(given, "point")));
    if (given.count("times")) hompm::cli::run_times(job, rounds_of(given));
  } catch (const hompm::cli::Interrupted& signal) {
    return signal.exit_code();
  }
  return given.count("gather") ? hompm::cli::write_study_files(job) : hompm::cli::success;
}

}  // namespace

int main(int argc, char** argv) {
  hompm::cli::catch_interruption("hompm-study");
  return hompm::cli::run_tool(this_tool(), argc, argv,
                              [](const auto& command_line) { return run(command_line.options); });
}
