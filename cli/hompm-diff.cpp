// hompm-diff: exact comparison of two run folders, and comparison of another code's results with one.
//
// Description:
//   Compares particles.csv, stress.csv and history.csv of folder A with those of folder B, bit for bit, and
//   scene.toml as text. Tolerances have to be asked for, field by field or for `all` of them. Says where the
//   two differ first and where each field differs most. The exit code tells the verdict: 0 identical or
//   equivalent, 3 different. Where A is a file, see foreign.hpp.

#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <hompm/verify/compare.hpp>

#include "bounds.hpp"
#include "common.hpp"
#include "comparison_text.hpp"
#include "foreign.hpp"
#include "trace_diff.hpp"

namespace {

namespace po = boost::program_options;

using Words = std::vector<std::string>;

hompm::cli::Tool this_tool() {
  return {
      .name = "hompm-diff",
      .usage = "[options] A B",
      .about =
          "Compares the results in the folder A with those in the golden folder B, bit for bit; "
          "or those of another code in the file A (- for standard input) with those in B and the exact "
          "solution; B may then be a scene file or a built-in case, too.",
      .examples = {"hompm-diff out golden/bar-large-bspline",
                   "hompm-diff --relative all=1e-2 mine.csv golden/bar-small-bspline"},
      .topics = {{"bounds",
                  "what may differ; FIELD is a column of a CSV file, or `all`: every field without a bound "
                  "of its own",
                  {"hompm-diff --relative stress=1e-9 out golden/bar-large-bspline",
                   "hompm-diff --ulps all=4 out golden/bar-large-bspline"},
                  {{"absolute", "FIELD=T...", "values of FIELD may differ by T, in its unit"},
                   {"relative", "FIELD=T...", "… by T times the largest value of FIELD at that time in B"},
                   {"ulps", "FIELD=N...", "… by N units in the last place"}}},
                 {"csv",
                  "when A is a file of another code",
                  {"hompm-diff --exact all=2e-2 --time 2.5 mine.csv golden/bar-small-bspline",
                   "hompm-diff --picture mine.svg mine.csv golden/bar-small-bspline"},
                  hompm::cli::foreign_options()},
                 {"traces",
                  "where two runs part",
                  {"hompm-diff --trace mine.trace theirs.trace"},
                  {{"trace", "", "A and B are files of hompm-run --trace: say where the runs part"}}},
                 {"outputs", "what is printed", {}, {{"quiet", "", "nothing; only the exit code tells"}}}},
      .remarks =
          "A value passes when it meets any of its bounds. Without bounds a single bit\n"
          "makes the two different. A file of another code is a table, .vtu, .vtp, .pvd or\n"
          "LAMMPS dump, maybe in .gz; it needs X, time and one of x, displacement,\n"
          "velocity, volume, density, stress, stretch, in any order. Particles are matched\n"
          "by X.\n"
          "Largest values are then those of all times, and only fields with a bound are\n"
          "judged, if any has one; with `all` each field of B must be there.\n\n"
          "Exit codes: 0 identical or equivalent, 2 bad usage, 3 different, 5 cannot read\n"
          "or write.\n",
      .takes_arguments = true};
}

nlohmann::ordered_json json(const hompm::Difference& d) {
  nlohmann::ordered_json object{{"file", d.file}, {"field", d.field}, {"time", d.time}};
  if (d.particle >= 0) object["particle"] = d.particle;
  object.update({{"a", d.a}, {"b", d.b}, {"ulps", d.ulps}});
  return object;
}

void print_json(const Words& folders, const hompm::Comparison& comparison) {
  auto fields = nlohmann::ordered_json::array();
  for (const auto& f : comparison.fields) {
    fields.push_back({{"file", f.file},
                      {"field", f.field},
                      {"values", f.values},
                      {"differing", f.differing},
                      {"beyond", f.beyond},
                      {"worst", f.differing > 0 ? json(f.worst) : nlohmann::ordered_json()}});
  }
  const nlohmann::ordered_json object{
      {"verdict", to_string(comparison.verdict)},
      {"a", folders[0]},
      {"b", folders[1]},
      {"messages", comparison.messages},
      {"notes", comparison.notes},
      {"first", comparison.first ? json(*comparison.first) : nlohmann::ordered_json()},
      {"fields", fields}};
  // Folder names may be any bytes.
  std::cout << object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
}

int compare(const po::variables_map& given, const Words& folders) {
  // 1. Read the command line.
  if (folders.size() != 2) {
    throw hompm::cli::UsageError("two folders to compare are needed, not " + std::to_string(folders.size()));
  }
  if (given.count("quiet") > 0 && given.count("json") > 0) {
    throw hompm::cli::UsageError("--quiet and --json contradict each other");
  }
  if (given.count("trace") > 0) {
    for (const char* bound : {"absolute", "relative", "ulps"})
      if (given.count(bound) > 0)
        throw hompm::cli::UsageError("--trace compares bits: it takes no --" + std::string(bound));
    hompm::cli::refuse_foreign_options(given);
    using hompm::cli::Report;
    return hompm::cli::diff_traces(folders[0], folders[1],
                                   given.count("json") > 0    ? Report::json
                                   : given.count("quiet") > 0 ? Report::none
                                                              : Report::text);
  }
  std::error_code missing;  // then it is nothing, and reading it says why
  if (!std::filesystem::is_directory(folders[0], missing)) {
    return hompm::cli::compare_csv(given, folders[0], folders[1]);
  }
  hompm::cli::refuse_foreign_options(given);
  if (std::filesystem::exists(folders[1], missing) && !std::filesystem::is_directory(folders[1], missing)) {
    throw hompm::cli::UsageError(
        folders[1] + " is a file, " + folders[0] +
        " a folder: a file of another code comes first, what it is held against second");
  }
  const auto tolerances = hompm::cli::read_tolerances(given, hompm::compared_fields());

  // 2. Compare.
  auto comparison = hompm::compare_folders(folders[0], folders[1], tolerances);
  hompm::compare_scenes(folders[0], folders[1], comparison);

  // 3. Report.
  if (given.count("json") > 0) {
    print_json(folders, comparison);
  } else if (given.count("quiet") == 0) {
    std::cout << hompm::cli::comparison_text(comparison);
  }
  return comparison.verdict == hompm::Verdict::different ? hompm::cli::different : hompm::cli::success;
}

}  // namespace

int main(int argc, char** argv) {
  return hompm::cli::run_tool(this_tool(), argc, argv, [](const auto& command_line) {
    return compare(command_line.options, command_line.arguments);
  });
}
