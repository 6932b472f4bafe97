// Transfers between particles and grid through the basis functions at the particles.
#pragma once

#include <cmath>

#include <hompm/error.hpp>
#include <hompm/plan/invalid.hpp>
#include <hompm/plan/state.hpp>

namespace hompm::detail {

/// Evaluates the grid functions at the particles. Throws `InvalidRun` for a particle outside the grid.
template <int P>
void evaluate_basis(State& state) {
  const auto& x = state.particles.position;
  for (std::size_t p = 0; p < x.size(); ++p) {
    const auto at = state.grid.locate(x[p]);
    if (at.cell < 0) throw_left_grid(state, p);
    state.basis.first[p] = at.cell;
    state.grid.evaluate<P>(at, &state.basis.values[p * (P + 1)], &state.basis.gradients[p * (P + 1)]);
  }
}

/// `target_i += Σ_p amount(p) w_i(x_p)`, with w the values or gradients of the basis at the particles. Sums
/// run in the order of the particles, so the bits are reproducible.
template <int P, class Amount>
void scatter(const State& state, const std::vector<double>& weights, std::vector<double>& target,
             Amount amount) {
  const std::size_t count = state.particles.size();
  for (std::size_t p = 0; p < count; ++p) {
    const double a = amount(p);
    const double* w = &weights[p * (P + 1)];
    double* t = &target[static_cast<std::size_t>(state.basis.first[p])];
    for (int k = 0; k <= P; ++k) t[k] += a * w[k];
  }
}

/// Σ_i w_i(x_p) field_i for one particle.
template <int P>
double gather(const State& state, const std::vector<double>& weights, const std::vector<double>& field,
              std::size_t p) {
  const double* w = &weights[p * (P + 1)];
  const double* f = &field[static_cast<std::size_t>(state.basis.first[p])];
  double sum = w[0] * f[0];
  for (int k = 1; k <= P; ++k) sum += w[k] * f[k];
  return sum;
}

}  // namespace hompm::detail
