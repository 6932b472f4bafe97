// A study as tables for other programs.
#pragma once

#include <string>
#include <vector>

#include <hompm/study/outcome.hpp>

namespace hompm::study {

/// points.csv: one row per point, failed ones included, everything but wall-clock time. A cell that has no
/// value is empty; a reason with a comma in it stands in quotes.
std::string points_csv(const std::vector<Outcome>& outcomes);

/// times.csv: the points that were timed; least, median and largest seconds.
std::string times_csv(const std::vector<Outcome>& outcomes);

/// study.json: the points as in points.csv, and the Pareto front of each field by instructions (by particle
/// steps where none were counted), as names of points.
std::string study_json(const Study& study, const std::vector<Outcome>& outcomes);

/// What the deterministic files measure cost by: instructions where all points that ran have them, else
/// particle steps.
Cost steady_cost(const std::vector<Outcome>& outcomes);

}  // namespace hompm::study
