// What a scene or a run should be told of: loads and fields too fine for steps and grid, which are refused or
// come with the warnings in run.json and on standard error.
#pragma once

#include <string>
#include <vector>

#include <hompm/simulation/run.hpp>

namespace hompm::detail {

/// A load or an initial field that is too fine.
struct Unresolved {
  Origin origin;
  std::string code;
  std::string text;  ///< how fine it is, and the number to take
  bool refused;      ///< it would act as something else; otherwise it is merely coarse
};

/// Looks at the scene with a time step (s). A period and a pulse take 4 steps or they are refused (sampling
/// at less than two would give another frequency, or nothing), 20 or they are coarse; a ramp of less than 4
/// is coarse: it acts as a jump. A wave of an initial field takes two particles or it is refused, four and
/// two cells or it is coarse.
std::vector<Unresolved> unresolved(const Scene& scene, double time_step);

}  // namespace hompm::detail

namespace hompm {

/// What can be said before the first step, `Scene::warnings` first:
/// - "unstable-in-time": what is known to go wrong in the end, update stress last with hat functions at a
///   moving free end (Sulsky, Zhou, Schreyer, Comput. Phys. Commun. 87 (1995) 236–252; Bardenhagen, J.
///   Comput. Phys. 180 (2002) 383–403);
/// - "coarse-load", "coarse-mode": a load or an initial field just above what steps or particles can carry
///   (what is below is refused);
/// - "no-rest": [rest] that cannot be reached, because a load goes on changing.
std::vector<Warning> warnings_before(const Scene& scene, const TimeStepping& stepping);

/// What the steps showed:
/// - "large-strain": strains beyond 10 % with the law linear, which holds for small ones;
/// - "energy-made": walls, contact, dampings, viscosities, plasticity gave energy, more than 1 % of all
///   that was there and of `scale`, what the loads may supply (J/m²), where each can only take it.
std::vector<Warning> warnings_after(const RunExtremes& extremes, double scale);

}  // namespace hompm
