#include "diff_options.hpp"

#include <algorithm>
#include <sstream>

namespace hompm::cli {
namespace {

/// FIELD=BOUND, taken apart.
struct Bound {
  std::string where;  ///< the option as it was typed, for messages
  std::string field;  ///< one of those known, or `all`
  std::string value;
};

/// What was given for `option`, which may be nothing. Throws `UsageError` for a field that is none of
/// `fields`.
std::vector<Bound> read_bounds(const CommandLine& given, const std::string& option,
                               const std::vector<std::string>& fields) {
  std::vector<Bound> bounds;
  for (const auto& word : given.texts(option)) {
    const std::string where = std::string("--").append(option).append(" ").append(word);
    const auto equals = word.find('=');
    if (equals == word.npos) throw UsageError(where + ": expected FIELD=BOUND, such as stress=3");
    const std::string field = word.substr(0, equals);
    if (field != "all" && std::find(fields.begin(), fields.end(), field) == fields.end()) {
      throw UsageError(
          std::string(where).append(": no field is called ").append(field).append(suggestion(field, fields)));
    }
    bounds.push_back({where, field, word.substr(equals + 1)});
  }
  return bounds;
}

double parse_bound(const std::string& text, const std::string& where) {
  const double bound = parse_number(text, where);
  if (bound < 0.0) throw UsageError(where + ": a bound cannot be negative");
  return bound;
}

/// The bound of each field that has one; `all` goes for every field that is not named. `parse` reads a value.
template <class Parse>
auto bounds_by_field(const std::vector<Bound>& bounds, const std::vector<std::string>& fields, Parse parse) {
  std::map<std::string, decltype(parse(std::string(), std::string()))> typed;
  for (const auto& bound : bounds) typed[bound.field] = parse(bound.value, bound.where);
  auto by_field = typed;
  by_field.erase("all");
  if (const auto all = typed.find("all"); all != typed.end()) {
    for (const auto& field : fields) by_field.try_emplace(field, all->second);
  }
  return by_field;
}

}  // namespace

std::map<std::string, Tolerance> read_tolerances(const CommandLine& given,
                                                 const std::vector<std::string>& fields) {
  std::map<std::string, Tolerance> tolerances;
  const auto add = [&](const std::string& option, auto member, auto parse) {
    for (const auto& [field, bound] : bounds_by_field(read_bounds(given, option, fields), fields, parse))
      tolerances[field].*member = bound;
  };
  add("absolute", &Tolerance::absolute, parse_bound);
  add("relative", &Tolerance::relative, parse_bound);
  add("ulps", &Tolerance::ulps, parse_count);
  return tolerances;
}

double seconds(const CommandLine& given, const std::string& option) {
  const std::string text = given.text(option);
  return given.has(option) ? parse_bound(text, "--" + option + " " + text) : 0.0;
}

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
      {"picture", "FILE", "draw A, B and exact solution: .svg, .png or .pdf, by gnuplot"}};
}

void refuse_foreign_options(const CommandLine& given) {
  for (const Option& option : foreign_options())
    if (given.has(option.name))
      throw UsageError("--" + option.name +
                       " goes with a file of another code in the place of A, which is a folder");
}

ForeignOptions read_foreign_options(const CommandLine& given) {
  ForeignOptions options;
  const auto& fields = foreign_fields();
  options.tolerances = read_tolerances(given, fields);
  options.exact = bounds_by_field(read_bounds(given, "exact", exact_fields()), exact_fields(), parse_bound);
  for (const std::string option : {"absolute", "relative", "ulps", "exact"}) {
    for (const auto& bound : read_bounds(given, option, fields)) {
      if (bound.field != "all") options.required.push_back(bound.field);
    }
  }
  for (const auto& list : given.texts("fields")) {
    std::istringstream names(list);
    for (std::string field; std::getline(names, field, ',');) {
      if (std::ranges::find(fields, field) == fields.end())
        throw UsageError(std::string("--fields ").append(list).append(": no field is called ").append(field) +
                         suggestion(field, fields));
      options.fields.push_back(field);
    }
  }
  auto columns = fields;
  columns.insert(columns.end(), {"X", "time", "particle", "body"});
  for (const auto& column : read_bounds(given, "column", columns))
    options.columns[column.field] = column.value;
  if (given.has("direction")) {
    const auto direction = given.text("direction");
    if (direction != "x" && direction != "y" && direction != "z")
      throw UsageError("--direction " + direction + ": it is x, y or z");
    options.direction = direction[0];
  }
  options.time_tolerance = seconds(given, "time-tolerance");
  options.interpolate = given.has("interpolate");
  for (const auto& text : given.texts("time")) options.times.push_back(parse_number(text, "--time " + text));
  return options;
}

}  // namespace hompm::cli
