// Reconstruction of particle data as functions, and the grid integrals of these (Tielen et al. 2017, section
// 3, with splines; others in docs/schemes.md).
#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

#include <hompm/numerics/cubic_spline.hpp>
#include <hompm/numerics/interpolating_spline.hpp>
#include <hompm/scheme/consistent_mass.hpp>
#include <hompm/scheme/gauss_points.hpp>

namespace hompm::detail {

/// Of a degree that keeps the order of a basis of degree P: a cubic does up to P = 3.
template <int P>
using MatchingSplines =
    std::conditional_t<(P > 3), numerics::InterpolatingSplineSites<5>, numerics::CubicSplineSites>;

/// Whether a consistent mass is part of the scheme, and the reconstructed density with it.
inline bool needs_density(const SchemeChoices& choices) {
  return choices.acceleration_mass == MassForm::consistent ||
         choices.velocity_projection == VelocityProjection::consistent;
}

inline bool keeps_cells(Conserve conserve) {
  return conserve == Conserve::cell_mass || conserve == Conserve::cell_momentum;
}

/// What stages need of a reconstruction, whatever the degree of the basis and the functions it is made of.
class Reconstruction : public Workspace {
 public:
  /// Sites and Gauss points for the present positions, and the density there where the scheme needs it.
  /// Throws `InvalidRun` for particles out of order.
  virtual void update_sites(const State& state) = 0;
  /// ρ(x_g) w_g, shifted in each cell where the scheme keeps cell masses. Throws `InvalidRun` where the
  /// density is not positive.
  virtual void update_density(const State& state) = 0;
  /// M_ij = Σ_g w_g ρ N_i N_j, factorised (consistent_mass.hpp). Where the scheme keeps momentum the diagonal
  /// takes what row sums lack to Σ m_p N_i, which must stand in `state.fields.mass`.
  virtual void update_consistent_mass(const State& state) = 0;
  /// M_i = Σ_g w_g ρ N_i: row sums of the consistent mass.
  virtual void row_sums(std::vector<double>& mass) = 0;
  /// f_i = Σ_g w_g σ(x_g) dN_i/dx(x_g) of one stress per particle.
  virtual void internal_force(const std::vector<double>& stress, std::vector<double>& force) = 0;
  /// b_i = Σ_g w_g ρ q(x_g) N_i(x_g), q reconstructed from the particle data: solving with the mass projects
  /// q. Where the scheme keeps cell momenta, ρ q is reconstructed as one field, and shifted so that Σ_g w_g ρ
  /// q is Σ m_p q_p in each cell.
  virtual void weighted_integrals(const State& state, const std::vector<double>& data,
                                  std::vector<double>& b) = 0;
  /// b_i = Σ_g w_g ρ v(x_g) N_i(x_g) of a field on the grid, with the density of `update_density`.
  virtual void momentum(const std::vector<double>& velocity, std::vector<double>& b) = 0;
  /// Solves Σ_j M_ij a_j = f_i in place; returns the sum of the reactions at fixed ends (Pa).
  virtual double solve(std::vector<double>& force_to_acceleration) = 0;
  /// Cᵀ f: what acts on functions that are tied goes to those they are tied to (consistent_mass.hpp).
  virtual void untie(std::vector<double>& force) const = 0;
};

/// `Sites` makes functions of particle data, used as numerics::CubicSplineSites. One factorisation serves
/// stress, density and velocity of a step, and so do the weights of the particle data at the Gauss points.
/// All memory is taken by the constructor.
template <int P, class Sites, int PerHalf>
class ReconstructionFrom final : public Cloned<Reconstruction, ReconstructionFrom<P, Sites, PerHalf>> {
 public:
  ReconstructionFrom(Sites sites, const State& state, const SchemeChoices& choices)
      : sites_(std::move(sites)),
        fit_(state.particles.size()),
        density_fit_(needs_density(choices) ? state.particles.size() : 0),
        gauss_(state.grid),
        weights_(gauss_.capacity()),
        mass_weight_(gauss_.capacity()),
        density_(needs_density(choices) ? state.particles.size() : 0),
        cell_mass_(keeps_cells(choices.conserve) ? gauss_.cells() : 0),
        cell_momentum_(choices.conserve == Conserve::cell_momentum ? gauss_.cells() : 0),
        momentum_density_(choices.conserve == Conserve::cell_momentum ? density_.size() : 0),
        momentum_weight_(choices.conserve == Conserve::cell_momentum ? gauss_.capacity() : 0),
        missing_(choices.conserve == Conserve::momentum ? state.fields.mass.size() : 0),
        mass_(state, choices),
        conserve_(choices.conserve) {}

  void update_sites(const State& state) override {
    const auto& x = state.particles.position;
    for (std::size_t i = 0; i < density_.size(); ++i) density_[i] = state.basis_density(i);
    const std::size_t bad =
        density_.empty() ? sites_.factorise(x) : sites_.factorise_and_fit(x, density_, density_fit_);
    if (bad != 0) throw_out_of_order(state, bad);
    gauss_.cover(state.grid, state.left_boundary, state.right_boundary);
    std::size_t interval = 0;
    for (std::size_t g = gauss_.begin(); g < gauss_.end(); ++g) {
      weights_[g] = sites_.weights(gauss_.position(g), interval);
      interval = weights_[g].interval;
    }
  }

  void update_density(const State& state) override {
    bool positive = true;
    for (std::size_t g = gauss_.begin(); g < gauss_.end(); ++g) {
      mass_weight_[g] = sites_.evaluate(weights_[g], density_fit_) * gauss_.weight(g);
      positive &= mass_weight_[g] > 0.0;
    }
    if (!positive) throw_first_negative_density(state);
    if (!cell_mass_.empty()) keep_cell_masses(state);
  }

  void update_consistent_mass(const State& state) override {
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
      const auto first = static_cast<std::size_t>(cell);
      for (std::size_t i = 0; i <= P; ++i)
        for (std::size_t j = 0; j <= i; ++j) mass_.entry(first + i, first + j) += block[i][j];
    }
    const auto begin = static_cast<std::size_t>(gauss_.first_cell());
    const auto end = static_cast<std::size_t>(gauss_.last_cell()) + P + 1;
    if (conserve_ == Conserve::momentum) {
      row_sums(missing_);
      for (std::size_t i = 0; i < missing_.size(); ++i) missing_[i] = state.fields.mass[i] - missing_[i];
    }
    mass_.factorise(state, begin, end, missing_);
  }

  void row_sums(std::vector<double>& mass) override {
    std::fill(mass.begin(), mass.end(), 0.0);
    add_integrals(
        mass, [&](std::size_t g) { return gauss_.values(g); },
        [&](std::size_t g) { return mass_weight_[g]; });
  }

  void internal_force(const std::vector<double>& stress, std::vector<double>& force) override {
    sites_.fit(stress, fit_);
    std::fill(force.begin(), force.end(), 0.0);
    add_integrals(
        force, [&](std::size_t g) { return gauss_.gradients(g); },
        [&](std::size_t g) { return gauss_.weight(g) * sites_.evaluate(weights_[g], fit_); });
  }

  void weighted_integrals(const State& state, const std::vector<double>& data,
                          std::vector<double>& b) override {
    std::fill(b.begin(), b.end(), 0.0);
    const auto values = [&](std::size_t g) { return gauss_.values(g); };
    if (conserve_ == Conserve::cell_momentum) {
      keep_cell_momenta(state, data);
      return add_integrals(b, values, [&](std::size_t g) { return momentum_weight_[g]; });
    }
    sites_.fit(data, fit_);
    add_integrals(b, values,
                  [&](std::size_t g) { return mass_weight_[g] * sites_.evaluate(weights_[g], fit_); });
  }

  void momentum(const std::vector<double>& velocity, std::vector<double>& b) override {
    std::fill(b.begin(), b.end(), 0.0);
    for (int cell = gauss_.first_cell(); cell <= gauss_.last_cell(); ++cell) {
      const double* v = &velocity[static_cast<std::size_t>(cell)];
      double* target = &b[static_cast<std::size_t>(cell)];
      for_points(cell, [&](std::size_t g) {
        const double* n = gauss_.values(g);
        double sum = 0.0;
        for (int k = 0; k <= P; ++k) sum += n[k] * v[k];
        for (int k = 0; k <= P; ++k) target[k] += mass_weight_[g] * sum * n[k];
      });
    }
  }

  double solve(std::vector<double>& force_to_acceleration) override {
    return mass_.solve(force_to_acceleration);
  }

  void untie(std::vector<double>& force) const override { mass_.untie(force); }

 private:
  using Points = GaussPoints<P, PerHalf>;

  template <class Visit>
  void for_points(int cell, Visit visit) const {
    const auto begin = static_cast<std::size_t>(cell) * Points::per_cell;
    for (std::size_t g = begin; g < begin + Points::per_cell; ++g) visit(g);
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
      for (std::size_t k = 0; k <= P; ++k) target[static_cast<std::size_t>(cell) + k] += sum[k];
    }
  }

  /// Shifts the density so that its integral over each cell is the sum of the masses there.
  void keep_cell_masses(const State& state) {
    const double* mass = state.particles.mass.data();
    sum_by_cells(state, cell_mass_, [&](std::size_t p) { return mass[p]; });
    shift_to_sums(mass_weight_, cell_mass_);
    for (std::size_t g = gauss_.begin(); g < gauss_.end(); ++g)
      if (!(mass_weight_[g] > 0.0))
        throw_negative_density(state, gauss_.position(g), mass_weight_[g] / gauss_.weight(g));
  }

  /// w_g ρ q at the Gauss points, its integral over each cell the sum of the m_p q_p there.
  void keep_cell_momenta(const State& state, const std::vector<double>& data) {
    const double* mass = state.particles.mass.data();
    for (std::size_t p = 0; p < data.size(); ++p) momentum_density_[p] = density_[p] * data[p];
    sites_.fit(momentum_density_, fit_);
    for (std::size_t g = gauss_.begin(); g < gauss_.end(); ++g)
      momentum_weight_[g] = gauss_.weight(g) * sites_.evaluate(weights_[g], fit_);
    sum_by_cells(state, cell_momentum_, [&](std::size_t p) { return mass[p] * data[p]; });
    shift_to_sums(momentum_weight_, cell_momentum_);
  }

  template <class Amount>
  static void sum_by_cells(const State& state, std::vector<double>& sums, Amount amount) {
    std::fill(sums.begin(), sums.end(), 0.0);
    for (std::size_t p = 0; p < state.particles.size(); ++p)
      sums[static_cast<std::size_t>(state.basis.first[p])] += amount(p);
  }

  /// Shifts an integrand at the Gauss points so that its integral over each cell is the sum said for it. A
  /// cell without particles, such as a narrow cut span, goes with the one before it.
  void shift_to_sums(std::vector<double>& integrand, const std::vector<double>& sums) const {
    const auto empty = [&](int cell) { return cell_mass_[static_cast<std::size_t>(cell)] == 0.0; };
    int begin = gauss_.first_cell();
    double sum = 0.0;
    bool no_mass = true;
    for (int cell = begin; cell <= gauss_.last_cell(); ++cell) {
      sum += sums[static_cast<std::size_t>(cell)];
      no_mass &= empty(cell);
      const bool last = cell == gauss_.last_cell();
      if (!last && (no_mass || empty(cell + 1))) continue;
      shift_to(integrand, begin, cell, sum);
      begin = cell + 1;
      sum = 0.0;
      no_mass = true;
    }
  }

  void shift_to(std::vector<double>& integrand, int begin, int last, double sum) const {
    const auto from = static_cast<std::size_t>(begin) * Points::per_cell;
    const auto to = static_cast<std::size_t>(last + 1) * Points::per_cell;
    double length = 0.0;
    for (std::size_t g = from; g < to; ++g) {
      sum -= integrand[g];
      length += gauss_.weight(g);
    }
    for (std::size_t g = from; g < to; ++g) integrand[g] += sum / length * gauss_.weight(g);
  }

  void throw_first_negative_density(const State& state) const {
    for (std::size_t g = gauss_.begin(); g < gauss_.end(); ++g) {
      const double density = sites_.evaluate(weights_[g], density_fit_);
      if (!(density > 0.0)) throw_negative_density(state, gauss_.position(g), density);
    }
  }

  Sites sites_;
  typename Sites::Fit fit_;
  typename Sites::Fit density_fit_;
  Points gauss_;
  std::vector<typename Sites::Weights> weights_;
  std::vector<double> mass_weight_;
  std::vector<double> density_;
  std::vector<double> cell_mass_;
  std::vector<double> cell_momentum_;
  std::vector<double> momentum_density_, momentum_weight_;
  std::vector<double> missing_;  ///< to the row sums Σ m_p N_i
  ConsistentMass<P> mass_;
  Conserve conserve_;
};

}  // namespace hompm::detail
