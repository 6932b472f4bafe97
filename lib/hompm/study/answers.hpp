// A study in words: what is cheapest for an error, and what the others need.
#pragma once

#include <string>
#include <vector>

#include <hompm/study/outcome.hpp>

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

}  // namespace hompm::study
