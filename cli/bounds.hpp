// Bounds as they are typed: --relative stress=1e-9 --relative all=1e-6.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include <hompm/verify/compare.hpp>

namespace hompm::cli {

/// FIELD=BOUND, taken apart.
struct Bound {
  std::string where;  ///< the option as it was typed, for messages
  std::string field;  ///< one of those known, or `all`
  std::string value;
};

/// What was given for `option`, which may be nothing. Throws `UsageError` for a field that is none of
/// `fields`.
std::vector<Bound> read_bounds(const boost::program_options::variables_map& given, const std::string& option,
                               const std::vector<std::string>& fields);

/// A number of at least 0. Throws `UsageError`.
double parse_bound(const std::string& text, const std::string& where);

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

/// The options --absolute, --relative and --ulps for `fields`. Throws `UsageError`.
std::map<std::string, Tolerance> read_tolerances(const boost::program_options::variables_map& given,
                                                 const std::vector<std::string>& fields);

}  // namespace hompm::cli
