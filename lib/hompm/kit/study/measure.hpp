// Runs one point of a study: its errors, its work, and states of it to count instructions from.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <hompm/kit/study/record.hpp>

namespace hompm::study {

/// Called after every step; throws to break off.
using Check = std::function<void()>;

/// A point that was run, and what of it is needed to count instructions.
struct Measured {
  Record record;
  TimeStepping stepping;
  /// States of the run to step from: after its first step, or the start of one that was refused or became
  /// invalid. None for settings that do not go together.
  std::vector<State> moments;
};

/// The scene of a point as it is measured. Throws `SceneError`.
Scene measured_scene(const Study& study, const Point& point);

/// Runs the point. What fails is told by `Record::status`; throws only what `check` throws.
Measured measure(const Study& study, const Point& point, const std::string& program, const Check& check);

/// Seconds that the steps of the scene take now, setting up left out. Throws as `run`.
double timed(const Scene& scene);

/// States to step from, as a file: what `hompm-study --count` reads. Throws `FileError`.
void write_moments(const std::filesystem::path& folder, const Measured& measured);

/// Does one step from each of the states that `write_moments` left in `folder`: the step that the run did
/// from there. How many steps that were. Throws `FileError`.
std::int64_t step_from_moments(const std::filesystem::path& folder);

}  // namespace hompm::study
