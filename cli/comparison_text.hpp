// A comparison for people to read.
#pragma once

#include <string>

#include <hompm/verify/compare.hpp>

namespace hompm::cli {

/// The verdict on the first line; then where the two differ first, the messages, the worst difference of each
/// field that differs in columns, and the notes.
std::string comparison_text(const Comparison& comparison);

}  // namespace hompm::cli
