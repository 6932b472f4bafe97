// hompm-diff: exact comparison of two run folders.
//
// Sample runs:
//   hompm-diff run golden/bar-large
//   hompm-diff --ulps all=4 run golden/bar-large
//   hompm-diff --relative stress=1e-9 --absolute displacement=1e-12 run golden/bar-large
//   hompm-diff --json run golden/bar-large
//
// Description:
//   Compares particles.csv, stress.csv and history.csv of folder A with those of folder B, bit for bit, and
//   scene.toml as text. Tolerances have to be asked for, field by field or for `all` of them. Says where the
//   two differ first and where each field differs most. The exit code tells the verdict: 0 identical or
//   equivalent, 3 different.

#include <algorithm>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <hompm/verify/compare.hpp>

#include "common.hpp"
#include "comparison_text.hpp"

namespace {

namespace po = boost::program_options;

constexpr const char* tool = "hompm-diff";
using Words = std::vector<std::string>;

po::options_description options() {
  po::options_description all("Options");
  const auto words = [](const char* name) { return po::value<Words>()->value_name(name)->composing(); };
  all.add_options()                                                                                //
      ("absolute", words("FIELD=T"), "values of FIELD may differ by T, in the unit of the field")  //
      ("relative", words("FIELD=T"), "… by T times the largest value of FIELD at that time in B")  //
      ("ulps", words("FIELD=N"), "… by N units in the last place")                                 //
      ("json", "print one JSON object")                                                            //
      ("quiet", "print nothing; only the exit code tells")                                         //
      ("help", "print this help and exit")                                                         //
      ("version", "print the version and exit");
  return all;
}

std::string usage_text() {
  std::ostringstream text;
  text << "usage: hompm-diff [options] A B\n\n"
          "Compares the results in the folders A and B (the golden one) bit for bit.\n\n"
       << options()
       << "\n"
          "FIELD is a column of particles.csv, stress.csv or history.csv, or `all`, which goes for\n"
          "every field that is not named in another bound of the same kind. A value passes when it\n"
          "meets any of its bounds. Without bounds a single bit makes the folders different.\n\n"
          "Exit codes: 0 identical or equivalent, 2 bad usage, 3 different, 5 cannot read.\n";
  return text.str();
}

/// FIELD=BOUND, taken apart.
struct Bound {
  std::string where;  ///< the option as it was typed, for messages
  std::string field;
  std::string value;
};

Bound read_bound(const std::string& option, const std::string& word) {
  const std::string where = "--" + option + " " + word;
  const auto& fields = hompm::compared_fields();
  const auto equals = word.find('=');
  if (equals == word.npos) throw hompm::cli::UsageError(where + ": expected FIELD=BOUND, such as stress=3");
  const std::string field = word.substr(0, equals);
  if (field != "all" && std::find(fields.begin(), fields.end(), field) == fields.end()) {
    throw hompm::cli::UsageError(where + ": no field is called " + field +
                                 hompm::cli::suggestion(field, fields));
  }
  return {where, field, word.substr(equals + 1)};
}

/// Reads all FIELD=BOUND of one option into `member` of the tolerances.
template <class Number, class Parse>
void add_tolerances(const po::variables_map& given, const std::string& option,
                    Number hompm::Tolerance::*member, Parse parse,
                    std::map<std::string, hompm::Tolerance>& tolerances) {
  if (given.count(option) == 0) return;
  std::map<std::string, Number> named;
  for (const auto& word : given[option].as<Words>()) {
    const auto bound = read_bound(option, word);
    named[bound.field] = parse(bound.value, bound.where);
  }
  for (const auto& field : hompm::compared_fields()) {
    auto found = named.find(field);
    if (found == named.end()) found = named.find("all");
    if (found != named.end()) tolerances[field].*member = found->second;
  }
}

double parse_bound(const std::string& text, const std::string& where) {
  const double bound = hompm::cli::parse_number(text, where);
  if (bound < 0.0) throw hompm::cli::UsageError(where + ": a bound cannot be negative");
  return bound;
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

int compare(int argc, char** argv) {
  // 1. Read the command line.
  if (argc < 2) {
    std::cerr << usage_text();
    return hompm::cli::usage;
  }
  const auto [given, folders] = hompm::cli::read_command_line(argc, argv, options());
  if (given.count("help") > 0) {
    std::cout << usage_text();
    return hompm::cli::success;
  }
  if (given.count("version") > 0) {
    std::cout << hompm::cli::version_text(tool) << '\n';
    return hompm::cli::success;
  }
  if (folders.size() != 2) {
    throw hompm::cli::UsageError("two folders to compare are needed, not " + std::to_string(folders.size()));
  }
  if (given.count("quiet") > 0 && given.count("json") > 0) {
    throw hompm::cli::UsageError("--quiet and --json contradict each other");
  }
  std::map<std::string, hompm::Tolerance> tolerances;
  add_tolerances(given, "absolute", &hompm::Tolerance::absolute, parse_bound, tolerances);
  add_tolerances(given, "relative", &hompm::Tolerance::relative, parse_bound, tolerances);
  add_tolerances(given, "ulps", &hompm::Tolerance::ulps, hompm::cli::parse_count, tolerances);

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
  return hompm::cli::run_tool(tool, [&] { return compare(argc, argv); });
}
