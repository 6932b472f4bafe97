// Transfers between particles and grid through the basis functions at the particles.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <hompm/plan/invalid.hpp>

namespace hompm::detail {

/// Of a particle that rounding alone has put outside, such as a marker at a fixed end: the end of the grid.
/// Throws `InvalidRun` for others.
numerics::SplineSpace::Location locate_outside(const State& state, std::size_t particle);

/// Evaluates the grid functions at the particles. Throws `InvalidRun` for a particle outside the grid.
template <int P>
void evaluate_basis(State& state) {
  const std::size_t count = state.particles.size();
  const double* x = state.particles.position.data();
  std::int32_t* first = state.basis.first.data();
  double* values = state.basis.values.data();
  double* gradients = state.basis.gradients.data();
  const numerics::SplineSpace& grid = state.grid;
  for (std::size_t p = 0; p < count; ++p, values += P + 1, gradients += P + 1) {
    auto at = grid.locate(x[p]);
    if (at.cell < 0) at = locate_outside(state, p);
    first[p] = at.cell;
    grid.evaluate<P>(at, values, gradients);
  }
}

/// The particles before `next` in one cell give its function ahead no mass: they are on the knot at the start
/// of the cell. Where no other particle gives it one, nor an essential condition a velocity, they go to the
/// cell behind, where their values are the same; where the function behind has neither, they have no
/// gradient.
void leave_cell_without_mass(State& state, std::size_t next);

/// `target_i += Σ_p amount(p) w_i(x_p)`, with w the values or gradients of the basis at the particles. Sums
/// run in the order of the particles, so the bits are reproducible; those of the cell under way stay in
/// registers. After those of a cell `after_cell(p, sum)` is called, with the next particle and the sum of the
/// last function so far.
template <int P, class Amount, class AfterCell>
void scatter(const State& state, const std::vector<double>& weights, std::vector<double>& target,
             Amount amount, AfterCell after_cell) {
  const std::size_t count = state.particles.size();
  const std::int32_t* first = state.basis.first.data();
  const double* w = weights.data();
  for (std::size_t p = 0; p < count;) {
    const std::int32_t cell = first[p];
    double* t = &target[static_cast<std::size_t>(cell)];
    std::array<double, P + 1> sum;
    for (std::size_t k = 0; k <= P; ++k) sum[k] = t[k];
    do {
      const double a = amount(p);
      for (std::size_t k = 0; k <= P; ++k) sum[k] += a * w[k];
      w += P + 1;
      ++p;
    } while (p < count && first[p] == cell);
    for (std::size_t k = 0; k <= P; ++k) t[k] = sum[k];
    after_cell(p, sum[P]);
  }
}
template <int P, class Amount>
void scatter(const State& state, const std::vector<double>& weights, std::vector<double>& target,
             Amount amount) {
  scatter<P>(state, weights, target, amount, [](std::size_t, double) {});
}

/// M_i = Σ_p m_p N_i. Hat functions have two gradients at a knot, and a particle there takes part in the
/// functions of the cell ahead; where the function ahead has no mass, in those of the cell behind.
template <int P>
void sum_masses(State& state) {
  std::vector<double>& mass = state.fields.mass;
  std::fill(mass.begin(), mass.end(), 0.0);
  const auto amount = [m = state.particles.mass.data()](std::size_t p) { return m[p]; };
  if constexpr (P == 1)
    scatter<P>(state, state.basis.values, mass, amount, [&](std::size_t next, double ahead) {
      if (!(ahead > 0.0)) leave_cell_without_mass(state, next);
    });
  else
    scatter<P>(state, state.basis.values, mass, amount);
}

/// Σ_p m_p q_p N_i
template <int P>
void sum_weighted(const State& state, const std::vector<double>& data, std::vector<double>& sums) {
  std::fill(sums.begin(), sums.end(), 0.0);
  scatter<P>(state, state.basis.values, sums,
             [mass = state.particles.mass.data(), q = data.data()](std::size_t p) { return mass[p] * q[p]; });
}

/// Σ_i w_i(x_p) field_i for one particle after the other.
template <int P>
class Gather {
 public:
  Gather(const State& state, const std::vector<double>& weights, const std::vector<double>& field)
      : first_(state.basis.first.data()), weights_(weights.data()), field_(field.data()) {}

  double operator()(std::size_t p) const {
    const double* w = weights_ + p * (P + 1);
    const double* f = field_ + first_[p];
    double sum = w[0] * f[0];
    for (int k = 1; k <= P; ++k) sum += w[k] * f[k];
    return sum;
  }

 private:
  const std::int32_t* first_;
  const double* weights_;
  const double* field_;
};

/// q_p += factor Σ_i N_i(x_p) field_i for every particle.
template <int P>
void add_at_particles(const State& state, double factor, const std::vector<double>& field,
                      std::vector<double>& target) {
  const std::size_t count = target.size();
  double* q = target.data();
  const Gather<P> at(state, state.basis.values, field);
  for (std::size_t p = 0; p < count; ++p) q[p] += factor * at(p);
}

/// f_i = Σ_cells h σ_c dN_i/dx for the hat functions. In a full cell, one between the ends of the material,
/// σ_c is the mean of the particle stresses there, weighted with the volumes: one Gauss point is exact. In
/// others it is Σ V_p σ_p / h, particle quadrature. (L. Beuth, Formulation and Application of a Quasi-Static
/// Material Point Method, University of Stuttgart 2012; I. K. J. Al-Kafaji, Formulation of a Dynamic Material
/// Point Method, University of Stuttgart 2013.) A cell without particles has no stress.
void mixed_internal_force(State& state, const std::vector<double>& stress);

}  // namespace hompm::detail
