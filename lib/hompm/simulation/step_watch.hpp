// Follows the critical step of a run as the configuration changes.
#pragma once

#include <hompm/simulation/run.hpp>

namespace hompm::detail {

/// After each step: computes the critical step again when waves have become faster, or after so many steps
/// that it costs less than 1 % of them, and raises `largest_step_fraction`. What it does depends on state and
/// extremes alone, so that a resumed run goes on with the same bits. Nothing moves with infinitesimal
/// kinematics, and nothing is looked at.
void watch_step(const Scene& scene, const std::vector<State>& states, RunExtremes& extremes);

/// Speed of the fastest waves in the bodies, m/s: √(dσ/dε / ρ).
double fastest_wave(const Scene& scene, const std::vector<State>& states);

}  // namespace hompm::detail
