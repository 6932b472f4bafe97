// A whole run: steps, outputs at their times, guards.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <hompm/simulation/simulation.hpp>
#include <hompm/simulation/time_step.hpp>

namespace hompm {

/// The largest values so far.
struct RunExtremes {
  double largest_residual = 0.0;            ///< of the energy balance, over the rows of the history, J/m²
  double largest_momentum_residual = 0.0;   ///< kg/(m s)
  double largest_internal_force_sum = 0.0;  ///< of |Σ f_int| / Σ |f_int|
  double largest_energy = 0.0;              ///< of kinetic + stored + the magnitude of gravity's, J/m²
  double largest_momentum = 0.0;            ///< of |Σ m v| + |impulse|, kg/(m s)
  double largest_step_fraction = 0.0;       ///< of the time step over the critical one
  double largest_wave_speed = 0.0;          ///< in the body, m/s, where it was looked at
  double largest_strain = 0.0;              ///< |λ − 1| with the law linear, where it was looked at
  double least_dissipated = 0.0;            ///< J/m²: below 0 where dissipation gave energy
};

struct RunResult : RunExtremes {
  std::int64_t steps = 0;   ///< that were done
  bool at_rest = false;     ///< the run ended because the body came to rest
  bool stopped = false;     ///< the run was stopped: there is no `final`
  double last_speed = 0.0;  ///< where the scene asks for rest, of the fastest particle in the last step, m/s
  HistoryRow start, end;
  Snapshot final;
  std::vector<Warning> warnings;  ///< `warnings_before` and `warnings_after` (simulation/warnings.hpp)
};

/// Where a run stands after a step: with the scene all that the rest of the run depends on.
struct RunPoint {
  std::vector<State> states;  ///< of all bodies
  RunExtremes extremes = {};
  double supplied = 0.0;         ///< largest energy that the loads supplied, J/m²
  std::int64_t quiet_steps = 0;  ///< since a particle last moved too fast for `Scene::rest`
};

/// What a run tells while it is under way; each may be empty.
struct RunObserver {
  std::function<void(const Snapshot&)> snapshot;
  std::function<void(const HistoryRow&)> history;
  std::function<void(std::int64_t step, std::int64_t steps)> progress;  ///< after every step
  std::function<void(const ProbeRow&)> probe = {};                      ///< of each `[[probe]]`
  /// Before the first step: may add stages to the plan.
  std::function<void(Simulation&)> start = {};
  /// After every `checkpoint_every` steps (none when that is 0), the last step left out. All that was
  /// reported before belongs to the point.
  std::function<void(const RunPoint&)> checkpoint = {};
  std::int64_t checkpoint_every = 0;
  bool checkpoint_at_end = false;  ///< after the last step, too
  /// Asked after every step but the last: should the run stop there? `checkpoint`, if any, then gets the
  /// point.
  std::function<bool()> stop = {};
};

/// Runs a scene with the given stepping. The start is reported first, then `scene.output.snapshots` snapshots
/// and `scene.output.history` rows evenly over the steps, and those of the probes. Throws `SceneError` when
/// scene and scheme do not go together or a value at the start is not finite, and `InvalidRun` when the run
/// becomes invalid: what was reported before is valid. Throws `ArithmeticError` on a machine or build whose
/// arithmetic is not IEEE 754 (numerics/floating_point.hpp).
///
/// With `from`, a point of an earlier run of the same scene, the run goes on from there: what is reported and
/// returned is the rest of that run, bit for bit.
RunResult run(const Scene& scene, const TimeStepping& stepping, const RunObserver& observer = {},
              const RunPoint* from = nullptr);

}  // namespace hompm
