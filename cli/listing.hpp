// What hompm-run can print without running: the catalogue (--list), the plan of a scene (--explain) and its
// critical step (--critical-step).
#pragma once

#include <string>

#include <hompm/scene/scene.hpp>
#include <hompm/simulation/time_step.hpp>

namespace hompm::cli {

/// Cases with their variants, schemes, materials and effects.
std::string catalogue_text();

/// The stages of a step in order, what called for each and what it owns, and the effects that are absent.
std::string plan_text(const Scene& scene, const TimeStepping& stepping);

/// The critical step of a scene at the start and, where free ends move, on their way through a cell.
std::string critical_step_text(const Scene& scene);

}  // namespace hompm::cli
