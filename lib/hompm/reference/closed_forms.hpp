// Solutions of the small-strain law (σ = E (λ − 1)) in closed form, after docs/method.md.
#pragma once

#include <optional>
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

/// What moves an elastic body of small strains from t = 0, all of it constant.
struct WaveProblem {
  LinearBody body;
  Ends ends = {};
  std::optional<InitialField> velocity = {}, displacement = {};  ///< the latter 0 at fixed ends
  double acceleration = 0.0;                                     ///< m/s², in +X
  double left = 0.0, right = 0.0;                                ///< Pa, at free ends, tension positive
};

/// d'Alembert's solution u = bt²/2 + F(X − ct) + G(X + ct), exact, jumps included. The start gives F and G
/// within the body; beyond it the left end gives F by G, the right end G by F: F(−s) = −b s²/(2c²) − G(s)
/// where it is fixed, G(s) − s σ/E where it is free under the stress σ, and likewise on the right. At a front
/// the values are those of one of its sides. With a fixed end all repeats itself after 4L/c. `time` in s, `X`
/// in m. (Graff, Wave Motion in Elastic Solids, 1975, section 1.1.)
ReferenceFields travelling_waves(const WaveProblem& problem, double time, std::span<const double> X);

/// Where a front is inside the body (m) that leaves the left end at t = 0 with the wave speed and is
/// reflected at both ends.
double front_from_left(const LinearBody& body, double time);

/// u = amplitude sin(πX/L) sin(πct/L), the solution of the effect `manufactured` (amplitude in m), for any
/// law.
ReferenceFields manufactured_bar(const LinearBody& body, const Material& material, double amplitude,
                                 double time, std::span<const double> X);

/// The body force ü − (∂σ/∂X)/ρ0 (m/s²) of which that is the solution, with the arguments above.
std::vector<double> manufactured_force(const LinearBody& body, const Material& material, double amplitude,
                                       double time, std::span<const double> X);

}  // namespace hompm
