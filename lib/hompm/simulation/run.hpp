// A whole run: steps, outputs at their times, guards.
#pragma once

#include <cstdint>
#include <functional>

#include <hompm/simulation/records.hpp>
#include <hompm/simulation/simulation.hpp>
#include <hompm/simulation/time_step.hpp>

namespace hompm {

/// What a run tells while it is under way; each may be empty.
struct RunObserver {
  std::function<void(const Snapshot&)> snapshot;
  std::function<void(const HistoryRow&)> history;
  std::function<void(std::int64_t step, std::int64_t steps)> progress;  ///< after every step
};

struct RunResult {
  std::int64_t steps = 0;  ///< that were done
  bool at_rest = false;    ///< the run ended because the body came to rest
  HistoryRow start, end;
  double largest_residual = 0.0;            ///< of the energy balance, over the rows of the history, J/m²
  double largest_momentum_residual = 0.0;   ///< kg/(m s)
  double largest_internal_force_sum = 0.0;  ///< of |Σ f_int| / Σ |f_int|
  double largest_energy = 0.0;              ///< of kinetic + stored + the magnitude of gravity's, J/m²
  double largest_momentum = 0.0;            ///< of |Σ m v| + |impulse|, kg/(m s)
  Snapshot final;
};

/// Runs a scene with the given stepping. The start is reported first, then `scene.output.snapshots` snapshots
/// and `scene.output.history` rows evenly over the steps. Throws `SceneError` when scene and scheme do not go
/// together, and `InvalidRun` when the run becomes invalid: what was reported before is valid. Throws `Error`
/// on a machine or build whose arithmetic is not IEEE 754 (numerics/floating_point.hpp).
RunResult run(const Scene& scene, const TimeStepping& stepping, const RunObserver& observer = {});

}  // namespace hompm
