// What particles take back from the grid velocity, after the forces have changed theirs (FLIP).
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <hompm/plan/plan.hpp>
#include <hompm/scheme/particle_transfer.hpp>

namespace hompm::detail {

/// ½ Σ m_p v_p², J/m²
double kinetic_energy(const Particles& particles);

/// Adds a stage that changes particle velocities. What it takes of Σ ½ m v² is booked as dissipated. A change
/// that damps does so in steps; after least squares the velocity at the start is projected, too.
template <class Change>
void join_velocity_change(const StageBuilder& builder, const std::string& name, Change change,
                          const Fields& scratch = {}) {
  const bool keeps_what_the_grid_sees =
      builder.scheme.choices.velocity_projection == VelocityProjection::least_squares;
  builder.add(
      {.name = name,
       .phase = keeps_what_the_grid_sees ? Phase::velocity : Phase::transfer,
       .reads = {"particles.mass"_field, "basis.first"_field, "basis.values"_field, "grid.velocity"_field},
       .changes = {"particles.velocity"_field, "balance.dissipated"_field, "balance.impulse"_field},
       .writes = scratch,
       .run = [change](State& state) {
         const double before = kinetic_energy(state.particles);
         change(state);
         state.balance.dissipated += before - kinetic_energy(state.particles);
       }});
}

/// v_p = Σ N_i v_i: nothing of the particle velocity is hidden from the grid.
template <int P>
void take_velocity(State& state) {
  const std::size_t count = state.particles.size();
  double* velocity = state.particles.velocity.data();
  const Gather<P> projected(state, state.basis.values, state.fields.velocity);
  for (std::size_t p = 0; p < count; ++p) velocity[p] = projected(p);
}

/// v_p ← α v_p + (1 − α) Σ N_i v_i, α the FLIP fraction (Stomakhin et al., ACM Trans. Graph. 32 (2013) 102).
template <int P>
void mix_velocity(State& state, double flip_fraction) {
  const std::size_t count = state.particles.size();
  double* velocity = state.particles.velocity.data();
  const Gather<P> projected(state, state.basis.values, state.fields.velocity);
  for (std::size_t p = 0; p < count; ++p)
    velocity[p] = flip_fraction * velocity[p] + (1.0 - flip_fraction) * projected(p);
}

/// v_p −= ((I − S P)^m v)_p, S the grid functions at the particles, P the projection to the grid: m = 1 is
/// PIC, and with m large only what the grid does not see is lost (Hammerquist, Nairn, Comput. Methods Appl.
/// Mech. Engrg. 318 (2017) 724–738, equation 17).
template <int P>
void join_hidden_velocity(const StageBuilder& builder,
                          const std::shared_ptr<const Discretisation>& discretisation) {
  const Field hidden = builder.field({"hidden_velocity", "m/s", "what the grid does not see"});
  const Field seen = builder.field({"seen_velocity", "m/s", "projection of the hidden one", Site::function});
  const auto remove = [=, order = builder.scheme.choices.xpic_order](State& state) {
    auto& velocity = state.particles.velocity;
    auto& rest = state[hidden];
    rest = velocity;
    double reaction = 0.0;
    for (int k = 0; k < order; ++k) {
      reaction = discretisation->project(state, rest, state[seen]);
      add_at_particles<P>(state, -1.0, state[seen], rest);
    }
    state.balance.impulse += reaction;  // what is left of the hidden momentum is its opposite
    for (std::size_t p = 0; p < rest.size(); ++p) velocity[p] -= rest[p];
  };
  join_velocity_change(builder, "particle velocity (XPIC)", remove, {hidden, seen});
}

/// The affine velocity v_p + c_p (x − x_p) of a particle, to the grid and back: C. Jiang, C. Schroeder, A.
/// Selle, J. Teran, A. Stomakhin, ACM Trans. Graph. 34 (2015) 51. x_i is the mean of the knots inside the
/// support of a function (Greville's abscissa, the node of a hat function), so that Σ N_i x_i = x.
template <int P>
class AffineVelocity {
 public:
  explicit AffineVelocity(const StageBuilder& builder)
      : gradient_(builder.field({.name = "velocity_gradient",
                                 .unit = "1/s",
                                 .meaning = "that particles carry (APIC)",
                                 .persists = true})) {
    const numerics::SplineSpace& grid = builder.state.grid;
    const Basis basis = builder.scheme.choices.basis;
    hats_ = basis == Basis::smoothed_gradients || (basis == Basis::splines && grid.degree() == 1);
    const int degree = grid.degree();
    for (int i = 0; i < grid.functions(); ++i) {
      int knots = 0;
      for (int k = 1; k <= degree; ++k) knots += std::clamp(i - degree + k, 0, grid.cells());
      abscissa_.push_back(grid.origin() + grid.cell_width() * knots / degree);
    }
  }

  /// Σ_p m_p (q_p + c_p (x_i − x_p)) N_i, x_p = Σ N_i x_i
  void sum_momentum(const State& state, const std::vector<double>& data, std::vector<double>& sums) const {
    sum_weighted<P>(state, data, sums);
    const Gather<P> middle(state, state.basis.values, abscissa_);
    const double* n = state.basis.values.data();
    const auto& gradient = state[gradient_];
    for (std::size_t p = 0; p < data.size(); ++p, n += P + 1) {
      const auto first = static_cast<std::size_t>(state.basis.first[p]);
      const double x = middle(p);
      const double slope = state.particles.mass[p] * gradient[p];
      for (std::size_t k = 0; k <= P; ++k) sums[first + k] += slope * (n[k] * (abscissa_[first + k] - x));
    }
  }

  /// c_p = Σ N_i v_i (x_i − x_p) / Σ N_i (x_i − x_p)², which is Σ N_i′ v_i for hat functions.
  void take_gradient(State& state) const {
    auto& gradient = state[gradient_];
    const auto& velocity = state.fields.velocity;
    const Gather<P> slope(state, state.basis.gradients, velocity);
    const Gather<P> middle(state, state.basis.values, abscissa_);
    const double* n = state.basis.values.data();
    for (std::size_t p = 0; p < gradient.size(); ++p, n += P + 1) {
      if (hats_) {
        gradient[p] = slope(p);
        continue;
      }
      const auto first = static_cast<std::size_t>(state.basis.first[p]);
      const double x = middle(p);
      double moment = 0.0, spread = 0.0;
      for (std::size_t k = 0; k <= P; ++k) {
        const double arm = abscissa_[first + k] - x;
        moment += n[k] * velocity[first + k] * arm;
        spread += n[k] * arm * arm;
      }
      gradient[p] = moment / spread;
    }
  }

  [[nodiscard]] Field gradient() const { return gradient_; }

 private:
  Field gradient_;
  bool hats_ =
      false;  ///< the values are those of hat functions, whose Σ N_i (x_i − x_p)² vanishes at the nodes
  std::vector<double> abscissa_;
};

template <int P>
void join_transfer(const StageBuilder& builder, const std::shared_ptr<const AffineVelocity<P>>& affine,
                   const std::shared_ptr<const Discretisation>& discretisation) {
  const SchemeChoices& choices = builder.scheme.choices;
  switch (choices.transfer) {
    case Transfer::flip:
      if (const double fraction = choices.flip_fraction; fraction < 1.0)
        join_velocity_change(builder, "particle velocity (FLIP and PIC)",
                             [fraction](State& state) { mix_velocity<P>(state, fraction); });
      return;
    case Transfer::pic: return join_velocity_change(builder, "particle velocity (PIC)", take_velocity<P>);
    case Transfer::xpic: return join_hidden_velocity<P>(builder, discretisation);
    case Transfer::apic:
      builder.add({.name = "gradient of the particle velocity (APIC)",
                   .phase = Phase::velocity,
                   .reads = {"basis.first"_field, "basis.values"_field, "basis.gradients"_field,
                             "grid.velocity"_field},
                   .writes = {affine->gradient()},
                   .run = [affine](State& state) { affine->take_gradient(state); }});
      join_velocity_change(builder, "particle velocity (PIC)", take_velocity<P>);
  }
}

}  // namespace hompm::detail
