#include "foreign.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include <nlohmann/json.hpp>

#include <hompm/output/staging.hpp>
#include <hompm/verify/foreign_comparison.hpp>

#include "bounds.hpp"
#include "foreign_formats.hpp"
#include "foreign_picture.hpp"
#include "foreign_text.hpp"
#include "progress.hpp"

namespace hompm::cli {
namespace {

namespace po = boost::program_options;
using Words = std::vector<std::string>;

ForeignOptions read_options(const po::variables_map& given) {
  ForeignOptions options;
  const auto& fields = foreign_fields();
  options.tolerances = read_tolerances(given, fields);
  options.exact = bounds_by_field(read_bounds(given, "exact", exact_fields()), exact_fields(), parse_bound);
  for (const std::string option : {"absolute", "relative", "ulps", "exact"}) {
    for (const auto& bound : read_bounds(given, option, fields)) {
      if (bound.field != "all") options.required.push_back(bound.field);
    }
  }
  const auto words = [&](const char* option) {
    return given.count(option) > 0 ? given[option].as<Words>() : Words();
  };
  for (const auto& list : words("fields")) {
    std::istringstream names(list);
    for (std::string field; std::getline(names, field, ',');) {
      if (std::ranges::find(fields, field) == fields.end())
        throw UsageError("--fields " + list + ": no field is called " + field + suggestion(field, fields));
      options.fields.push_back(field);
    }
  }
  auto columns = fields;
  columns.insert(columns.end(), {"X", "time", "particle", "body"});
  for (const auto& column : read_bounds(given, "column", columns))
    options.columns[column.field] = column.value;
  if (given.count("direction") > 0) {
    const auto direction = given["direction"].as<std::string>();
    if (direction != "x" && direction != "y" && direction != "z")
      throw UsageError("--direction " + direction + ": it is x, y or z");
    options.direction = direction[0];
  }
  if (given.count("time-tolerance") > 0) {
    const auto text = given["time-tolerance"].as<std::string>();
    options.time_tolerance = parse_bound(text, "--time-tolerance " + text);
  }
  options.interpolate = given.count("interpolate") > 0;
  for (const auto& text : words("time")) options.times.push_back(parse_number(text, "--time " + text));
  return options;
}

/// Which variant of the scheme A agrees with.
int tell_variants(const po::variables_map& given, const std::filesystem::path& table, const std::string& a,
                  const std::string& b, const ForeignOptions& options) {
  for (const char* option : {"absolute", "relative", "ulps", "exact", "time", "time-tolerance", "fields",
                             "interpolate", "submit", "picture"})
    if (given.count(option) > 0)
      throw UsageError("--which tells digits at all times of A: it takes no --" + std::string(option));
  SchemeVariants variants;
  {
    ProgressBar bar(given.count("quiet") > 0, "variants");
    variants = scheme_variants(table, b, options, [&](auto done, auto all) { bar.update(done, all); });
  }
  if (given.count("json") > 0)
    std::cout << variants_json(variants, a, b);
  else if (given.count("quiet") == 0)
    std::cout << variants_text(variants, a, b);
  return success;
}

/// A new folder for golden/others: the table, and what its author has to say of it, to be filled in.
void submit(const std::string& folder, const std::filesystem::path& table, const std::filesystem::path& b) {
  std::error_code none;
  if (std::filesystem::exists(folder, none)) throw UsageError("--submit " + folder + ": it is there already");
  const bool results = std::filesystem::is_directory(b, none);
  const std::string name = (results ? (b / "").parent_path() : b).filename().string();
  nlohmann::ordered_json code;
  for (const char* word : {"code", "authors", "version", "language", "settings", "machine", "ran_by"})
    code[word] = "";
  code["results"] = {
      {{"file", "results.csv"},
       {"case", name},
       {"run", results ? "--scene golden/" + name + "/scene.toml --snapshots 2" : "--scene " + b.string()},
       {"ns_per_particle_and_step", nullptr}}};
  std::ostringstream text;
  if (!(text << std::ifstream(table).rdbuf())) throw FileError("cannot read " + table.string());
  detail::StagingFolder made(folder);
  made.replace("results.csv", text.str());
  made.replace("code.json",
               code.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace

std::vector<Option> foreign_options() {
  return {
      {"exact", "FIELD=T...", "FIELD may differ from the exact solution by T times its largest value in B"},
      {"time", "T...", "compare only time T of B, in s"},
      {"interpolate", "", "compute times that A lacks from those around them"},
      {"fields", "LIST...", "compare only these fields, such as displacement,stress"},
      {"column", "FIELD=NAME...", "FIELD (X, time, particle, body) is the column NAME, or the NAMEth"},
      {"direction", "D", "of a 2D or 3D code's results: x, y or z"},
      {"time-tolerance", "T", "times that differ by T s or less are the same"},
      {"time-step", "T", "of a dump that counts steps, in s"},
      {"submit", "FOLDER", "make a folder for golden/others of A, to be filled in"},
      {"which", "", "run variants of the scheme of B, and say which A agrees with, to how many digits"},
      {"picture", "FILE", "draw A, B and exact solution: .svg or .png, by gnuplot"}};
}

void refuse_foreign_options(const po::variables_map& given) {
  for (const Option& option : foreign_options())
    if (given.count(option.name) > 0)
      throw UsageError("--" + option.name +
                       " goes with a file of another code in the place of A, which is a folder");
}

int compare_csv(const po::variables_map& given, const std::string& csv, const std::string& folder) {
  ForeignOptions options = read_options(given);
  options.name = csv == "-" ? "standard input" : csv;
  const bool draws = given.count("picture") > 0;
  const std::string picture = draws ? given["picture"].as<std::string>() : "";
  if (draws) require_picture_name(picture);
  ForeignComparison comparison;
  try {
    double step = 0.0;
    if (given.count("time-step") > 0) {
      const auto text = given["time-step"].as<std::string>();
      step = parse_bound(text, "--time-step " + text);
    }
    const TableFile table(csv, options.direction, step);
    if (given.count("which") > 0) return tell_variants(given, table.path(), csv, folder, options);
    comparison = compare_foreign(table.path(), folder, options);
    if (given.count("submit") > 0) submit(given["submit"].as<std::string>(), table.path(), folder);
  } catch (const OptionError& error) {
    throw UsageError(error.what());
  }
  if (given.count("json") > 0) {
    std::cout << foreign_json(comparison, csv, folder);
  } else if (given.count("quiet") == 0) {
    std::cout << foreign_text(comparison);
  }
  if (draws) {
    const std::string obstacle = draw_picture(comparison, picture);
    if (!obstacle.empty()) std::cerr << "hompm-diff: no picture: " << obstacle << '\n';
  }
  return comparison.verdict == Verdict::different ? different : success;
}

}  // namespace hompm::cli
