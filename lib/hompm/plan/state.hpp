// All fields of a run as plain arrays: what the stages of a plan work on.
#pragma once

#include <cstdint>
#include <vector>

#include <hompm/numerics/spline_space.hpp>
#include <hompm/scene/scene.hpp>

namespace hompm {

/// One entry per particle, ordered by reference position. The displacement is what is summed up, and the
/// position follows from it: small motions far from the origin keep their digits.
struct Particles {
  std::vector<double> reference_position;  ///< X, m
  std::vector<double> displacement;        ///< u, m
  std::vector<double> position;            ///< x = X + u, m (X itself with infinitesimal kinematics)
  std::vector<double> velocity;            ///< m/s
  std::vector<double> mass;                ///< kg/m²
  std::vector<double> reference_volume;    ///< m
  std::vector<double> volume;              ///< V = V0 λ, m (V0 with infinitesimal kinematics)
  std::vector<double> stretch;             ///< λ
  std::vector<double> stress;              ///< σ, Pa

  [[nodiscard]] std::size_t size() const { return mass.size(); }
};

/// Grid functions at the particles: for each particle the first function that is not zero there, and the
/// values and gradients (1/m) of the degree + 1 functions from that one on.
struct BasisAtParticles {
  std::vector<std::int32_t> first;
  std::vector<double> values;
  std::vector<double> gradients;
};

/// One entry per grid function.
struct GridFields {
  std::vector<double> mass;            ///< row sums Σ m_p N_i, kg/m²
  std::vector<double> internal_force;  ///< Pa
  std::vector<double> force;           ///< out of balance: external − internal, Pa
  std::vector<double> acceleration;    ///< m/s²
  std::vector<double> velocity;        ///< m/s, of the last projection
};

/// Sums over the steps so far, for the balances.
struct Balance {
  double dissipated = 0.0;     ///< J/m²
  double external_work = 0.0;  ///< J/m²
  double impulse = 0.0;        ///< of all forces on the body, kg/(m s)
};

struct State {
  std::int64_t step = 0;
  double time = 0.0;       ///< s
  double time_step = 0.0;  ///< s

  numerics::SplineSpace grid;
  Ends ends;
  double total_mass = 0.0;     ///< kg/m²
  double left_boundary = 0.0;  ///< of the material, m
  double right_boundary = 0.0;

  Particles particles;
  BasisAtParticles basis;
  GridFields fields;
  Balance balance;
};

/// The state of a scene at t = 0: particles at (2i − 1)/(2k) of each cell with equal volumes, initial
/// velocity, no stress; the grid reaches `margin_cells` beyond each free end. Allocates every array a step
/// needs.
State initial_state(const Scene& scene);

}  // namespace hompm
