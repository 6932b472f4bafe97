// The picture of a study: error against cost.
#pragma once

#include <string>
#include <vector>

#include <hompm/study/outcome.hpp>

namespace hompm::study {

/// A script for gnuplot that draws NAME.svg and NAME.png: relative L2 error against cost, one panel per
/// field. Each run is a dot, each scheme's front a line, the front of all a grey band, the reference's own
/// error a dashed floor. A failed point is a cross at the upper edge, at the cost it was planned with, or at
/// the left edge where that is not known either.
std::string picture_script(const std::vector<Outcome>& outcomes, Cost cost, const std::string& title,
                           const std::string& name);

}  // namespace hompm::study
