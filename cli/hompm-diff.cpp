// hompm-diff: exact comparison of two run folders, and comparison of another code's results with one.
//
// Sample runs:
//   hompm-diff run golden/bar-large
//   hompm-diff --ulps all=4 run golden/bar-large
//   hompm-diff --relative stress=1e-9 --absolute displacement=1e-12 run golden/bar-large
//   hompm-diff --json run golden/bar-large
//   hompm-diff --relative all=1e-2 theirs.csv golden/bar-large
//   hompm-diff --trace mine.trace theirs.trace
//
// Description:
//   Compares particles.csv, stress.csv and history.csv of folder A with those of folder B, bit for bit, and
//   scene.toml as text. Tolerances have to be asked for, field by field or for `all` of them. Says where the
//   two differ first and where each field differs most. The exit code tells the verdict: 0 identical or
//   equivalent, 3 different. Where A is a CSV file, see foreign.hpp.

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

po::options_description options() {
  po::options_description all("Options");
  const auto words = [](const char* name) { return po::value<Words>()->value_name(name)->composing(); };
  all.add_options()                                                                                //
      ("absolute", words("FIELD=T"), "values of FIELD may differ by T, in the unit of the field")  //
      ("relative", words("FIELD=T"), "… by T times the largest value of FIELD at that time in B")  //
      ("ulps", words("FIELD=N"), "… by N units in the last place")                                 //
      ("trace", "A and B are files of hompm-run --trace: say where the runs part first")           //
      ("json", "print one JSON object")                                                            //
      ("quiet", "print nothing; only the exit code tells");
  return all.add(hompm::cli::foreign_options());
}

hompm::cli::Tool this_tool() {
  return {
      .name = "hompm-diff",
      .synopsis =
          "usage: hompm-diff [options] A B\n\n"
          "Compares the results in the folder A with those in the folder B (the golden one) bit for bit;\n"
          "or the results of another code in the CSV file A with those in B and with the exact solution:\n\n"
          "  hompm-diff --relative all=1e-2 --picture mine.svg mine.csv golden/bar-small-bspline\n",
      .options = options(),
      .remarks =
          "FIELD is a column of particles.csv, stress.csv or history.csv, or `all`, which goes for\n"
          "every field that is not named in another bound of the same kind. A value passes when it\n"
          "meets any of its bounds. Without bounds a single bit makes the two different.\n\n"
          "A CSV file needs the columns X, time and one of x, displacement, velocity, volume, density,\n"
          "stress, stretch, in any order; others are let pass. Particles are matched by X. Largest\n"
          "values are then those of all times, and only fields with a bound are judged, if any has one.\n\n"
          "Exit codes: 0 identical or equivalent, 2 bad usage, 3 different, 5 cannot read or write.\n",
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
  std::error_code unreadable;  // then it is not a file, and the comparison says why
  if (std::filesystem::is_regular_file(folders[0], unreadable)) {
    return hompm::cli::compare_csv(given, folders[0], folders[1]);
  }
  hompm::cli::refuse_foreign_options(given);
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
