// What a scene or a run should be told of though it goes on: in run.json and on standard error.
#pragma once

#include <vector>

#include <hompm/scene/scene.hpp>
#include <hompm/simulation/run.hpp>
#include <hompm/simulation/time_step.hpp>

namespace hompm {

/// What can be said before the first step, `Scene::warnings` first:
/// - "unstable-in-time": what is known to go wrong in the end, update stress last with hat functions at a
///   moving free end (Sulsky, Zhou, Schreyer, Comput. Phys. Commun. 87 (1995) 236–252; Bardenhagen, J.
///   Comput. Phys. 180 (2002) 383–403);
/// - "coarse-load", "coarse-mode": a load or an initial field just above what steps or particles can carry
///   (simulation/resolution.hpp refuses what is below);
/// - "no-rest": [rest] that cannot be reached, because a load goes on changing.
std::vector<Warning> warnings_before(const Scene& scene, const TimeStepping& stepping);

/// What the steps showed:
/// - "large-strain": strains beyond 10 % with the law linear, which holds for small ones;
/// - "energy-made": walls, contact, dampings, viscosities, plasticity gave energy, more than 1 % of all
///   that was there and of `scale`, what the loads may supply (J/m²), where each can only take it.
std::vector<Warning> warnings_after(const RunExtremes& extremes, double scale);

}  // namespace hompm
