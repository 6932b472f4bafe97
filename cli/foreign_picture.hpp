// The picture of a comparison with another code's results.
#pragma once

#include <string>

#include <hompm/kit/verify/foreign_comparison.hpp>

namespace hompm::cli {

/// Draws displacement, velocity and stress (those that A has) of A and B over X with the exact solution, one
/// row of panels per time, and errors below; `a` and `b` are their names. Says what is in the way when there
/// is nothing to draw, or as `draw`, which also says what it throws.
std::string draw_picture(const ForeignComparison& comparison, const std::string& a, const std::string& b,
                         const std::string& file);

}  // namespace hompm::cli
