// From what a scene says about its time step to the step and the number of steps.
#pragma once

#include <cstdint>

#include <hompm/scene/scene.hpp>

namespace hompm {

struct TimeStepping {
  double time_step = 0.0;           ///< s
  std::int64_t steps = 0;           ///< from 0 to the end time
  double critical_time_step = 0.0;  ///< s

  /// Time (s) after `step` steps, exactly `end_time` after the last.
  [[nodiscard]] double time(std::int64_t step, double end_time) const {
    return step == steps ? end_time : static_cast<double>(step) * time_step;
  }
};

/// The step that `scene.scheme` asks for by `time_step`, `courant` (c Δt/h) or `step_fraction` (of the
/// critical step), shortened where needed so that a whole number of steps ends at `end_time`. Throws
/// `SceneError` for a step above the critical one, unless `allow_unstable` is set, naming the limit; for more
/// than 10¹⁰ steps; for a part of the critical step that is far longer than the run; and for loads and
/// initial fields that would act as something else (simulation/warnings.hpp), naming the number to take.
/// Throws `ArithmeticError` as `run` does.
TimeStepping time_stepping(const Scene& scene);

/// That of a run which goes on with the step it had (s), to an end time that may be later than it was: where
/// that is no whole number of steps, `scene.end_time` becomes the next that is. Throws as above.
TimeStepping resumed_stepping(Scene& scene, double time_step);

}  // namespace hompm
