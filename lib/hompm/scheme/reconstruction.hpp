// Reconstruction of particle data as cubic splines, and the grid integrals of the splines (Tielen et al.
// 2017, section 3).
#pragma once

#include <cmath>
#include <vector>

#include <hompm/numerics/band_ldlt.hpp>
#include <hompm/numerics/cubic_spline.hpp>
#include <hompm/plan/invalid.hpp>
#include <hompm/scheme/gauss_points.hpp>

namespace hompm::detail {

/// One factorisation of the spline matrix serves stress, density and velocity of a step, and so do the
/// weights of the particle data at the Gauss points. All memory is taken by the constructor.
template <int P>
class Reconstruction {
 public:
  explicit Reconstruction(const State& state)
      : splines_(state.particles.size()),
        gauss_(state.grid),
        weights_(gauss_.capacity()),
        mass_weight_(gauss_.capacity()),
        data_(state.particles.size()),
        second_derivatives_(state.particles.size()),
        mass_(static_cast<std::size_t>(state.grid.functions())) {}

  /// Splines and Gauss points for the present positions. Throws `InvalidRun` for particles out of order.
  void update_sites(const State& state) {
    if (const std::size_t bad = splines_.factorise(state.particles.position)) throw_out_of_order(state, bad);
    gauss_.cover(state.grid, state.left_boundary, state.right_boundary);
    std::size_t interval = 0;
    for (std::size_t g = gauss_.begin(); g < gauss_.end(); ++g) {
      weights_[g] = splines_.weights(gauss_.position(g), interval);
      interval = weights_[g].interval;
    }
  }

  /// ρ(x_g) w_g from the spline through the particle densities m/V. Throws `InvalidRun` where the spline is
  /// not positive.
  void update_density(const State& state) {
    const Particles& p = state.particles;
    for (std::size_t i = 0; i < data_.size(); ++i) data_[i] = p.mass[i] / p.volume[i];
    splines_.second_derivatives(data_, second_derivatives_);
    for (std::size_t g = gauss_.begin(); g < gauss_.end(); ++g) {
      const double density = splines_.evaluate(weights_[g], data_, second_derivatives_);
      if (!(density > 0.0)) throw_negative_density(state, gauss_.position(g), density);
      mass_weight_[g] = density * gauss_.weight(g);
    }
  }

  /// M_ij = Σ_g w_g ρ N_i N_j, factorised for the functions that touch material and no essential condition
  /// fixes.
  void update_consistent_mass(const State& state) {
    find_active(state);
    mass_.clear();
    for (int cell = gauss_.first_cell(); cell <= gauss_.last_cell(); ++cell) {
      double block[P + 1][P + 1] = {};
      for_points(cell, [&](std::size_t g) {
        const double* n = gauss_.values(g);
        for (int i = 0; i <= P; ++i) {
          const double weighted = mass_weight_[g] * n[i];
          for (int j = 0; j <= i; ++j) block[i][j] += weighted * n[j];
        }
      });
      for (int i = 0; i <= P; ++i)
        for (int j = 0; j <= i; ++j)
          mass_.lower(static_cast<std::size_t>(cell) + static_cast<std::size_t>(i),
                      static_cast<std::size_t>(i - j)) += block[i][j];
    }
    if (const std::size_t row = mass_.factorise(active_begin_, active_end_); row != active_end_)
      throw_singular_mass(state, row);
  }

  /// f_i = Σ_g w_g σ(x_g) dN_i/dx(x_g).
  void internal_force(State& state) {
    splines_.second_derivatives(state.particles.stress, second_derivatives_);
    auto& force = state.fields.internal_force;
    std::fill(force.begin(), force.end(), 0.0);
    add_integrals(
        force, [&](std::size_t g) { return gauss_.gradients(g); },
        [&](std::size_t g) {
          return gauss_.weight(g) *
                 splines_.evaluate(weights_[g], state.particles.stress, second_derivatives_);
        });
  }

  /// Grid velocity from Σ_j M_ij v_j = Σ_g w_g ρ v(x_g) N_i(x_g).
  void project_velocity(State& state) {
    splines_.second_derivatives(state.particles.velocity, second_derivatives_);
    auto& velocity = state.fields.velocity;
    std::fill(velocity.begin(), velocity.end(), 0.0);
    add_integrals(
        velocity, [&](std::size_t g) { return gauss_.values(g); },
        [&](std::size_t g) {
          return mass_weight_[g] *
                 splines_.evaluate(weights_[g], state.particles.velocity, second_derivatives_);
        });
    std::fill_n(velocity.begin(), active_begin_, 0.0);
    std::fill(velocity.begin() + static_cast<std::ptrdiff_t>(active_end_), velocity.end(), 0.0);
    mass_.solve(active_begin_, active_end_, velocity);
  }

 private:
  template <class Visit>
  void for_points(int cell, Visit visit) const {
    const auto begin = static_cast<std::size_t>(cell) * GaussPoints<P>::per_cell;
    for (std::size_t g = begin; g < begin + GaussPoints<P>::per_cell; ++g) visit(g);
  }

  template <class Weights, class Amount>
  void add_integrals(std::vector<double>& target, Weights weights, Amount amount) const {
    for (int cell = gauss_.first_cell(); cell <= gauss_.last_cell(); ++cell) {
      double sum[P + 1] = {};
      for_points(cell, [&](std::size_t g) {
        const double a = amount(g);
        const double* w = weights(g);
        for (int k = 0; k <= P; ++k) sum[k] += a * w[k];
      });
      for (int k = 0; k <= P; ++k)
        target[static_cast<std::size_t>(cell) + static_cast<std::size_t>(k)] += sum[k];
    }
  }

  /// All functions that touch material but those fixed. One that no particle sees yet is among them: without
  /// it the functions there would not sum to one, and uniform motion would not be kept.
  void find_active(const State& state) {
    active_begin_ = static_cast<std::size_t>(gauss_.first_cell());
    active_end_ = static_cast<std::size_t>(gauss_.last_cell()) + P + 1;
    if (state.ends.left == End::fixed && active_begin_ == 0) ++active_begin_;
    if (state.ends.right == End::fixed && active_end_ == state.fields.mass.size()) --active_end_;
  }

  numerics::CubicSplineSites splines_;
  GaussPoints<P> gauss_;
  std::vector<numerics::CubicSplineSites::Weights> weights_;
  std::vector<double> mass_weight_;
  std::vector<double> data_, second_derivatives_;
  numerics::BandLdlt<P> mass_;
  std::size_t active_begin_ = 0, active_end_ = 0;
};

}  // namespace hompm::detail
