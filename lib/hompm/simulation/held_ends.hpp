// Whether what holds an end leaves small motions bounded: by trial.
#pragma once

#include <hompm/scene/scene.hpp>

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
