#include "bounds.hpp"

#include <algorithm>

#include "common.hpp"

namespace hompm::cli {

std::vector<Bound> read_bounds(const boost::program_options::variables_map& given, const std::string& option,
                               const std::vector<std::string>& fields) {
  std::vector<Bound> bounds;
  if (given.count(option) == 0) return bounds;
  for (const auto& word : given[option].as<std::vector<std::string>>()) {
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

std::map<std::string, Tolerance> read_tolerances(const boost::program_options::variables_map& given,
                                                 const std::vector<std::string>& fields) {
  std::map<std::string, Tolerance> tolerances;
  const auto add = [&](const std::string& option, auto member, auto parse) {
    for (const auto& [field, bound] : bounds_by_field(read_bounds(given, option, fields), fields, parse)) {
      tolerances[field].*member = bound;
    }
  };
  add("absolute", &Tolerance::absolute, parse_bound);
  add("relative", &Tolerance::relative, parse_bound);
  add("ulps", &Tolerance::ulps, parse_count);
  return tolerances;
}

}  // namespace hompm::cli
