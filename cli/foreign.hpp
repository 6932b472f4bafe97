// hompm-diff with a file of another code in the place of the first folder.
#pragma once

#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "common.hpp"

namespace hompm::cli {

/// The options that only go with a file of another code.
std::vector<Option> foreign_options();

/// Throws `UsageError` when an option is given that only goes with a file of another code.
void refuse_foreign_options(const boost::program_options::variables_map& given);

/// Compares, prints, draws; the exit code. Throws `UsageError`, `FileError`, `SceneError`.
int compare_csv(const boost::program_options::variables_map& given, const std::string& csv,
                const std::string& folder);

}  // namespace hompm::cli
