// The largest stable time step of a scene's scheme.
#pragma once

#include <hompm/simulation/linear_step.hpp>

namespace hompm {

/// The critical step of a scheme in any configuration. The scheme's own step, linearised there
/// (simulation/linear_step.hpp), has modes of the angular frequency ω; with Euler–Cromer and leapfrog it is
/// stable exactly when Δt ω ≤ 2 for all of them, other compositions of kicks and drifts have a limit of their
/// own (derived in docs/stability.md); viscosity and damping make it smaller. The largest ω is found to 1 %,
/// from a fixed start: the same configuration gives the same bits.
class CriticalStep {
 public:
  /// Throws `SceneError` when the scene cannot be started.
  explicit CriticalStep(const Scene& scene);

  /// In the configuration of `state`, a state of the scene (s). Throws `InvalidRun` where a step would.
  double at(const State& state);

  /// The same, with the free ends that move `cut` of a cell beyond a breakpoint each.
  double with_cut(const State& state, double cut);

 private:
  double of_linearised();

  double phase_;  ///< the largest stable ω Δt
  SmallMotion effects_;
  double relaxation_rate_;
  LinearStep linear_;
};

/// True where an end of the body moves through the grid.
bool moving_free_end(const Scene& scene);

/// The critical step (s) that a scene starts with. Where free ends move through the grid it is the smallest
/// of those met on the way: just beyond a breakpoint, and when one of the two outer particles has just passed
/// one (docs/stability.md). Throws `SceneError` when the scene cannot be started, or when a moving end would
/// make the mass singular.
double critical_time_step(const Scene& scene);

}  // namespace hompm
