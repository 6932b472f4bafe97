// A comparison with another code's results, as text for the reader or as JSON.
#pragma once

#include <string>

#include <hompm/verify/foreign_comparison.hpp>
#include <hompm/verify/variants.hpp>

namespace hompm::cli {

/// Verdict, what is wrong, a table of errors, notes; each line ends in a line end.
std::string foreign_text(const ForeignComparison& comparison);

/// The same as one JSON object, every number in full; null for what is not known or not finite.
std::string foreign_json(const ForeignComparison& comparison, const std::string& a, const std::string& b);

/// The variants that agree best, as a table, and where the file leaves the scene as it is.
std::string variants_text(const SchemeVariants& variants, const std::string& a, const std::string& b);

/// All of them as one JSON object.
std::string variants_json(const SchemeVariants& variants, const std::string& a, const std::string& b);

}  // namespace hompm::cli
