// The field on the grid nearest to particle data.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <hompm/scheme/consistent_mass.hpp>
#include <hompm/scheme/gauss_points.hpp>
#include <hompm/scheme/particle_transfer.hpp>

namespace hompm::detail {

/// The field q_i for which Σ_p w_p (Σ N_i q_i − q_p)² is least: (Σ_p w_p N_i N_j) q_j = Σ_p w_p N_i q_p, over
/// the functions that no essential condition fixes. A projection to rounding: fields of the
/// grid pass it unchanged, polynomials up to degree P among them, and a smooth one is off by O(h^{P+1})
/// however coarse the particles are as a quadrature.
///
/// w_p is the mass, so that the projection of the velocity never adds kinetic energy and keeps the momentum.
/// Markers, which have none, get a tenth of their neighbour's: a polynomial of degree 4 that reaches beyond
/// the last particle to the end of the body is otherwise known too poorly (docs/high-order.md). With
/// `Conserve::momentum` they get none.
template <int P>
class LeastSquares : public Cloned<Workspace, LeastSquares<P>> {
 public:
  LeastSquares(const State& state, const SchemeChoices& choices)
      : normal_(state, choices), weight_(state.particles.mass) {
    if (!choices.markers || choices.conserve == Conserve::momentum) return;
    constexpr double share = 0.1;
    weight_.front() = share * weight_[1];
    weight_.back() = share * weight_[weight_.size() - 2];
  }

  /// For the present basis at the particles. Throws `InvalidRun` when the particles do not determine a field.
  void update(const State& state) {
    normal_.clear();
    constexpr std::size_t stencil = P + 1;
    const std::size_t count = weight_.size();
    const std::int32_t* first = state.basis.first.data();
    const double* weight = weight_.data();
    const double* n = state.basis.values.data();
    for (std::size_t p = 0; p < count;) {
      const std::int32_t cell = first[p];
      const auto f = static_cast<std::size_t>(cell);
      double block[stencil][stencil];
      for (std::size_t i = 0; i < stencil; ++i)
        for (std::size_t j = 0; j <= i; ++j) block[i][j] = normal_.entry(f + i, f + j);
      do {
        for (std::size_t i = 0; i < stencil; ++i) {
          const double weighted = weight[p] * n[i];
          for (std::size_t j = 0; j <= i; ++j) block[i][j] += weighted * n[j];
        }
        n += stencil;
        ++p;
      } while (p < count && first[p] == cell);
      for (std::size_t i = 0; i < stencil; ++i)
        for (std::size_t j = 0; j <= i; ++j) normal_.entry(f + i, f + j) = block[i][j];
    }
    // Of the cell beyond a breakpoint that an outer particle is on it touches nothing, as the mass does: a
    // body and its mirror image have the same functions.
    const auto& x = state.particles.position;
    const double hair = rounding_of_ends * state.grid.cell_width();
    const bool splines = state.grid.degree() == P;
    const bool none_before = splines && x.front() > state.grid.breakpoint(first[0] + 1) - hair;
    const bool none_behind = splines ? x.back() < state.grid.breakpoint(first[count - 1]) + hair
                                     : state.basis.values[count * stencil - 1] == 0.0;
    normal_.factorise(state, static_cast<std::size_t>(first[0]) + (none_before ? 1 : 0),
                      static_cast<std::size_t>(first[count - 1]) + stencil - (none_behind ? 1 : 0));
  }

  /// The field for one entry of `data` per particle. Returns what fixed ends add to Σ w_p q_p.
  double project(const State& state, const std::vector<double>& data, std::vector<double>& field) const {
    std::fill(field.begin(), field.end(), 0.0);
    scatter<P>(state, state.basis.values, field,
               [weight = weight_.data(), q = data.data()](std::size_t p) { return weight[p] * q[p]; });
    return normal_.solve(field);
  }

 private:
  ConsistentMass<P> normal_;
  std::vector<double> weight_;
};

}  // namespace hompm::detail
