// Whether time steps, particles and grid can carry what a scene asks of them.
#pragma once

#include <string>
#include <vector>

#include <hompm/scene/scene.hpp>

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
