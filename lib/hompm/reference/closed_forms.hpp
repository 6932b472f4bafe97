// Solutions of the small-strain law (σ = E (λ − 1)) in closed form, after docs/method.md.
#pragma once

#include <span>

#include <hompm/materials/material.hpp>
#include <hompm/reference/reference.hpp>

namespace hompm {

/// An elastic body of small strains.
struct LinearBody {
  double length;      ///< m
  double density;     ///< kg/m³
  double wave_speed;  ///< m/s, c = √(E/ρ0)
};

/// Free vibration between fixed ends from v(X, 0) = amplitude sin(kπX/L), k the mode (amplitude in m/s):
/// u = amplitude/ω sin(ωt) sin(kπX/L), ω = kπc/L. `time` in s, `X` in m. (Tielen et al. 2017.)
ReferenceFields vibrating_bar(const LinearBody& body, double amplitude, int mode, double time,
                              std::span<const double> X);

/// Free vibration between fixed ends from u(X, 0) = amplitude sin(kπX/L) at rest (amplitude in m): u =
/// amplitude cos(ωt) sin(kπX/L), with the notation of `vibrating_bar`.
ReferenceFields released_bar(const LinearBody& body, double amplitude, int mode, double time,
                             std::span<const double> X);

/// A column at rest, fixed at X = 0 and free at X = L, from t = 0 under the acceleration b (m/s², in +X):
/// d'Alembert's form of the series of Tielen et al. (2017), exact. Up to t = 2L/c, with a = t − X/c, d = t −
/// (2L − X)/c and ()₊ the positive part: u = (b/2)(t² − a₊² − d₊²); from there the motion runs backwards,
/// with the period 4L/c. Seen by a freely falling observer it is the base that moves, and sends out waves.
ReferenceFields loaded_column(const LinearBody& body, double acceleration, double time,
                              std::span<const double> X);

/// u = amplitude sin(πX/L) sin(πct/L), the solution of the effect `manufactured` (amplitude in m), for any
/// law.
ReferenceFields manufactured_bar(const LinearBody& body, const Material& material, double amplitude,
                                 double time, std::span<const double> X);

}  // namespace hompm
