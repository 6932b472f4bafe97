// What hompm-run can print without running: the catalogue (--list) and the plan of a scene (--explain).
#pragma once

#include <string>

#include <hompm/scene/scene.hpp>
#include <hompm/simulation/time_step.hpp>

namespace hompm::cli {

/// Cases with their variants, schemes, materials and effects.
std::string catalogue_text();

/// The stages of a step in order, what called for each and what it owns, and the effects that are absent.
std::string plan_text(const Scene& scene, const TimeStepping& stepping);

}  // namespace hompm::cli
