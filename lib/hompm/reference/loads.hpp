// What the effects of a scene amount to, as far as the reference solutions know them.
#pragma once

#include <optional>
#include <vector>

#include <hompm/scene/amplitude.hpp>

namespace hompm {

/// A load that may change with time.
struct Load {
  double value = 0.0;  ///< m/s², in +X on every point, or Pa at an end, tension positive
  Amplitude amplitude = {};
};

/// The sum of loads at a time (s).
double total(const std::vector<Load>& loads, double time);
/// The sum in the end; nothing where one oscillates for ever.
std::optional<double> final_total(const std::vector<Load>& loads);

/// Loads and damping of a scene; several effects of one kind add up.
struct Loads {
  std::vector<Load> gravity;
  double damping_rate = 0.0;   ///< 1/s, of the mass-proportional damping −β ρ0 v
  double viscosity = 0.0;      ///< Pa s, η of the stress η ∂v/∂x
  bool local_damping = false;  ///< non-viscous damping, which no differential equation describes
  std::vector<Load> left;      ///< at the end X = 0, if it is free
  std::vector<Load> right;     ///< at the end X = length, if it is free

  [[nodiscard]] bool damped() const { return damping_rate != 0.0 || viscosity != 0.0; }
};

/// The loads of a scene, or nothing if it has an effect that is none of gravity, traction, mass-damping,
/// local-damping, viscosity.
std::optional<Loads> loads_of(const Scene& scene);

}  // namespace hompm
