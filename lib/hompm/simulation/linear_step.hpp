// The scheme's own step, linearised in a configuration, which its stability depends on; and a trial of what
// holds an end.
#pragma once

#include <vector>

#include <hompm/effects/registry.hpp>
#include <hompm/simulation/simulation.hpp>

namespace hompm {

/// A body of the scene, undeformed and at rest, of small strain and law linear; with no effect but what the
/// effects that hold its ends say of these (`EffectType::join_linear`). Throws as `Simulation`.
Simulation linear_simulation(const Scene& scene, const SchemeSpec& scheme, LinearEnd ends, double time_step);

/// With positions frozen, a step is a linear map of the particles' velocity and stress: the stress makes the
/// force, the force changes velocities, these go to the grid, whose velocity strains the particles. One turn
/// from stress to stress, with all time steps 1, has the eigenvalues −ω² of the modes (derived in
/// docs/stability.md). Without effects and relaxation. Of stresses, because particles do not feel what is
/// left undetermined on the grid: the function on a cut span that holds no particle.
///
/// A transfer that keeps the part f of a mode's velocity in a step, 0 ≤ f ≤ 1, lowers the limit: what counts
/// is 2/(1 + f) times that turn. With USL the kick goes straight to the grid, K, and once more through the
/// particles, K': what counts is 2 K − 2 f/(1 + f) K'. f is taken as small as the transfer can make it. Where
/// with USL nothing is kept but what the grid velocity says (PIC, APIC), what counts is 2 (I + R)⁻¹ K, R what
/// becomes of a grid velocity that goes to the particles and back. USF has the limit of MUSL.
class LinearStep {
 public:
  /// Throws as `Simulation`.
  explicit LinearStep(const Scene& scene);

  /// Takes the configuration of a state of the same scene: positions, densities, and the tangent of the law
  /// at the present stretch. Throws `InvalidRun` where the stages that look at positions do.
  void linearise(const State& state);

  /// As `linearise`, with the body stretched by less than a cell so that each free end lies `cut` of a cell
  /// beyond a breakpoint. Density and wave speed of the material stay.
  void linearise_with_cut(const State& state, double cut);

  /// The size of the vectors: one entry per particle, markers included.
  [[nodiscard]] std::size_t size() const { return stiffening_.size(); }

  /// One turn; `result` holds `size()` entries, Pa/s².
  void apply(const std::vector<double>& stress, std::vector<double>& result);

 private:
  /// The configuration, stretched so that the body reaches from `left` to `right`.
  void take(const State& state, double left, double right);

  /// Forces of the stress, velocities, and the stress of the motion alone.
  void run_step();
  /// The stress of the motion with the grid velocity, from rest.
  void strain();
  /// Makes of K s, where `run_step` has left the grid velocity of it, 2 (I + R)⁻¹ K s.
  void add_returns(std::vector<double>& result);

  SchemeChoices choices_;
  Material material_;
  double youngs_modulus_;
  Simulation simulation_;
  std::vector<double> stiffening_;  ///< tangent of the law over its modulus at rest, per particle
};

}  // namespace hompm

namespace hompm::detail {

/// True where an end of the body is held by an effect of its own (piston, wall, absorbing; not by another
/// body).
bool has_held_ends(const Scene& scene);

/// Does `steps` of `time_step` (s) from noise with such a scene, at small strain, with nothing
/// but its held ends: a piston or wall that stands still, or an absorbing end. False when the noise grows.
///
/// With few particles per cell that cannot be said by an eigenvalue of the free body: the projection to the
/// grid is not symmetric, and the same end is pushed and felt as two different ones (docs/stability.md).
bool stays_bounded(const Scene& scene, double time_step, int steps);

}  // namespace hompm::detail
