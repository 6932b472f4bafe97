// The state of rest, for any law.
#pragma once

#include <span>

#include <hompm/reference/reference.hpp>

namespace hompm {

/// Equilibrium of a body fixed at X = 0 and free at X = L, under the acceleration b (m/s², in +X) and the
/// stress `pull` (Pa) at X = L: from ∂σ/∂X + ρ0 b = 0 the stress is σ = σ_L + ρ0 b (L − X), the law gives
/// λ(σ), and u = ∫ (λ − 1) dX by Gauss–Legendre quadrature, to rounding (derived in docs/method.md, with the
/// closed form for the law `rate`). `X` in m, ascending. Throws `Error` where the law cannot carry the
/// stress.
ReferenceFields static_equilibrium(const Scene& scene, double acceleration, double pull,
                                   std::span<const double> X);

}  // namespace hompm
