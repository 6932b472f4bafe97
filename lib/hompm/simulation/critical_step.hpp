// The largest stable time step of a scene's scheme.
#pragma once

#include <hompm/scene/scene.hpp>

namespace hompm {

/// Critical time step (s) of the scheme on the scene's undeformed configuration. The scheme's own step, run
/// on the linear law at frozen positions, is a linear map of particle velocity and stress: v' = v + Δt A σ,
/// σ' = σ + Δt D v'. With Euler–Cromer and leapfrog it is stable exactly when Δt² ρ(D A) ≤ 4; other
/// compositions of kicks and drifts have a limit of their own (derived in docs/method.md, "Critical step").
/// The spectral radius is found by power iteration from a fixed start, so the same scene gives the same bits;
/// tests hold it to 1 % of a dense eigenvalue solve.
double critical_time_step(const Scene& scene);

}  // namespace hompm
