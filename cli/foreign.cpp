#include "foreign.hpp"

#include <algorithm>
#include <iostream>

#include <hompm/verify/foreign_comparison.hpp>

#include "bounds.hpp"
#include "foreign_picture.hpp"
#include "foreign_text.hpp"

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
  options.interpolate = given.count("interpolate") > 0;
  if (given.count("time") > 0) {
    for (const auto& text : given["time"].as<Words>()) {
      options.times.push_back(parse_number(text, "--time " + text));
    }
  }
  return options;
}

}  // namespace

std::vector<Option> foreign_options() {
  return {
      {"exact", "FIELD=T...", "FIELD may differ from the exact solution by T times its largest value in B"},
      {"time", "T...", "compare only time T of B, in s"},
      {"interpolate", "", "compute times that A lacks from those around them"},
      {"picture", "FILE", "draw A, B and exact solution: .svg or .png, by gnuplot"}};
}

void refuse_foreign_options(const po::variables_map& given) {
  for (const Option& option : foreign_options())
    if (given.count(option.name) > 0)
      throw UsageError("--" + option.name + " goes with a CSV file in the place of A, which is a folder");
}

int compare_csv(const po::variables_map& given, const std::string& csv, const std::string& folder) {
  const ForeignOptions options = read_options(given);
  const bool draws = given.count("picture") > 0;
  const std::string picture = draws ? given["picture"].as<std::string>() : "";
  if (draws) require_picture_name(picture);
  ForeignComparison comparison;
  try {
    comparison = compare_foreign(csv, folder, options);
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
