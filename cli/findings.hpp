// What a comparison finds, as text for people and as one JSON object.
#pragma once

#include <string>

#include <hompm/kit/recorder/trace.hpp>
#include <hompm/kit/verify/variants.hpp>

namespace hompm::cli {

/// The verdict on the first line; then where the two differ first, the messages, a table of the worst
/// differences or errors of each field, and the notes. Each line ends in a line end.
std::string text_of(const Comparison& found);
std::string text_of(const ForeignComparison& found);
std::string text_of(const TraceComparison& found);

/// The same as one JSON object, every number in full; null for what is not known or not finite. `a` and `b`
/// are what was compared, by names of any bytes.
std::string json_of(const Comparison& found, const std::string& a, const std::string& b);
std::string json_of(const ForeignComparison& found, const std::string& a, const std::string& b);
std::string json_of(const TraceComparison& found, const std::string& a, const std::string& b);

/// The variants that agree best, as a table, and where the file leaves the scene as it is.
std::string text_of(const SchemeVariants& variants, const std::string& a, const std::string& b);
/// All of them as one JSON object.
std::string json_of(const SchemeVariants& variants, const std::string& a, const std::string& b);

}  // namespace hompm::cli
