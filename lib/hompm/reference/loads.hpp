// What the effects of a scene amount to, as far as the reference solutions know them.
#pragma once

#include <optional>
#include <vector>

#include <hompm/scene/scene.hpp>

namespace hompm {

struct BodyForce {
  double acceleration = 0.0;  ///< m/s², in +X, on every point
  double ramp_time = 0.0;     ///< s, until it acts in full
};

/// Loads and damping of a scene; several effects of one kind add up.
struct Loads {
  std::vector<BodyForce> gravity;
  double damping_rate = 0.0;   ///< 1/s, of the mass-proportional damping −β ρ0 v
  bool local_damping = false;  ///< non-viscous damping, which no differential equation describes
  double left_stress = 0.0;    ///< Pa, at the end X = 0, if it is free; tension positive
  double right_stress = 0.0;   ///< Pa, at the end X = length, if it is free; tension positive

  /// m/s², in +X, at a time (s).
  [[nodiscard]] double acceleration(double time) const;
  /// m/s², once all ramps are over.
  [[nodiscard]] double full_acceleration() const;
  [[nodiscard]] bool ramped() const;
};

/// The loads of a scene, or nothing if it has an effect that is none of gravity, traction, mass-damping,
/// local-damping.
std::optional<Loads> loads_of(const Scene& scene);

}  // namespace hompm
