// The options of hompm-diff: bounds, such as --relative stress=1e-9 --relative all=1e-6, and those that only
// go with a file of another code in the place of the first folder.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <hompm/kit/verify/foreign_comparison.hpp>

#include "common.hpp"

namespace hompm::cli {

/// The options --absolute, --relative and --ulps for `fields`; `all` goes for every field that is not named.
/// Throws `UsageError`.
std::map<std::string, Tolerance> read_tolerances(const CommandLine& given,
                                                 const std::vector<std::string>& fields);

/// The value of an option, at least 0; 0 where it was not given. Throws `UsageError`.
double seconds(const CommandLine& given, const std::string& option);

/// The options that only go with a file of another code, what they say, and a `UsageError` for one of them.
std::vector<Option> foreign_options();
ForeignOptions read_foreign_options(const CommandLine& given);
void refuse_foreign_options(const CommandLine& given);

}  // namespace hompm::cli
