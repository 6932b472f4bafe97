// The picture of a comparison with another code's results.
#pragma once

#include <string>

#include <hompm/kit/verify/foreign_comparison.hpp>

namespace hompm::cli {

/// Throws `UsageError` when the name does not end in .svg or .png.
void require_picture_name(const std::string& file);

/// Draws displacement, velocity and stress (those that A has) of A and B over X with the exact solution, one
/// row of panels per time, and errors below. The file appears whole or not at all. Says what is in the way
/// when there is nothing to draw or nothing to draw with, or "". Throws `FileError`.
std::string draw_picture(const ForeignComparison& comparison, const std::string& file);

}  // namespace hompm::cli
