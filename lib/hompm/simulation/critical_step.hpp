// The largest stable time step of a scene's scheme.
#pragma once

#include <hompm/scene/scene.hpp>

namespace hompm {

/// Critical time step (s) of the scheme on the scene's undeformed configuration. The scheme's own step, run
/// on the linear law at frozen positions, is a linear map of particle velocity and stress: v' = v + Δt A σ,
/// σ' = σ + Δt D v'. It is stable exactly when Δt² ρ(D A) ≤ 4 (derived in docs/method.md, "Critical step").
/// The spectral radius is found by power iteration from a fixed start, so the same scene gives the same bits;
/// it is a few 0.1 % from the eigenvalue at most.
double critical_time_step(const Scene& scene);

}  // namespace hompm
