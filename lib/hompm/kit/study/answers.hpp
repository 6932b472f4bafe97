// A study in words, as tables for other programs, and as a picture of error against cost.
#pragma once

#include <string>
#include <vector>

#include <hompm/kit/study/outcome.hpp>

namespace hompm::study {

/// A few digits for people: "38", "1.2e6", "3.1e-4".
std::string brief(double value);

/// "`high-order` p = 3, 16 cells, 2 per cell, courant 0.4": the setting of an outcome in words.
std::string setting_text(const Outcome& outcome);

/// "hompm-run --case bar …": the command that runs the setting.
std::string command_text(const Study& study, const Outcome& outcome);

/// One sentence: what reaches `error` (relative L2) of the field at the least cost, and how much more each
/// other scheme needs, or its best error where no setting of the sweep gets there.
std::string answer(const std::vector<Outcome>& outcomes, Field field, Cost cost, double error);

/// The sentences for 1e-1, 1e-2, …, as long as something gets there, for each field; one a line, each field
/// under a heading.
std::string answers(const std::vector<Outcome>& outcomes, Cost cost);

/// What each field's reference is, and what failed and why, in lines.
std::string remarks(const std::vector<Outcome>& outcomes);

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

/// A script for gnuplot that draws NAME.svg and NAME.png: relative L2 error against cost, one panel per
/// field. Each run is a dot, each scheme's front a line, the front of all a grey band, the reference's own
/// error a dashed floor. A failed point is a cross at the upper edge, at the cost it was planned with, or at
/// the left edge where that is not known either.
std::string picture_script(const std::vector<Outcome>& outcomes, Cost cost, const std::string& title,
                           const std::string& name);

}  // namespace hompm::study
