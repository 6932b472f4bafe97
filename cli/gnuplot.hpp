// gnuplot, as a program that may or may not be there.
#pragma once

#include <optional>
#include <string>

namespace hompm::cli {

/// What gnuplot writes to standard output for `script`; nothing when it is not installed. Throws `FileError`
/// with what gnuplot says when it fails.
std::optional<std::string> run_gnuplot(const std::string& script);

}  // namespace hompm::cli
