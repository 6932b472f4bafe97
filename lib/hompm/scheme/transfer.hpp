// What particles take back from the grid velocity, after the forces have changed theirs (FLIP).
#pragma once

#include <memory>

#include <hompm/plan/plan.hpp>
#include <hompm/scheme/particle_transfer.hpp>

namespace hompm::detail {

/// ½ Σ m_p v_p², J/m²
double kinetic_energy(const Particles& particles);

/// Adds a stage that changes particle velocities. What it takes of Σ ½ m v² is booked as dissipated. A change
/// that damps does so in steps; after least squares the velocity at the start is projected, too.
template <class Change>
void join_velocity_change(PlanBuilder& builder, const std::string& name, Change change,
                          const std::string& arrays = {}) {
  const bool keeps_what_the_grid_sees =
      builder.scene.scheme.choices.velocity_projection == VelocityProjection::least_squares;
  builder.add(
      keeps_what_the_grid_sees ? Phase::velocity : Phase::transfer, name,
      [change](State& state) {
        const double before = kinetic_energy(state.particles);
        change(state);
        state.balance.dissipated += before - kinetic_energy(state.particles);
      },
      arrays);
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
class HiddenVelocity {
 public:
  explicit HiddenVelocity(const PlanBuilder& builder)
      : project_(builder.project),
        order_(builder.scene.scheme.choices.xpic_order),
        hidden_(builder.state.particles.size()),
        projected_(builder.state.fields.mass.size()) {}

  void remove(State& state) {
    hidden_ = state.particles.velocity;
    double reaction = 0.0;
    for (int k = 0; k < order_; ++k) {
      reaction = project_(state, hidden_, projected_);
      add_at_particles<P>(state, -1.0, projected_, hidden_);
    }
    state.balance.impulse += reaction;  // what is left of the hidden momentum is its opposite
    for (std::size_t p = 0; p < hidden_.size(); ++p) state.particles.velocity[p] -= hidden_[p];
  }

 private:
  decltype(PlanBuilder::project) project_;
  int order_;
  std::vector<double> hidden_, projected_;
};

/// The affine velocity v_p + c_p (x − x_p) of a particle, to the grid and back: C. Jiang, C. Schroeder, A.
/// Selle, J. Teran, A. Stomakhin, ACM Trans. Graph. 34 (2015) 51. x_i is the mean of the knots inside the
/// support of a function (Greville's abscissa, the node of a hat function), so that Σ N_i x_i = x.
template <int P>
class AffineVelocity {
 public:
  explicit AffineVelocity(const State& state, const SchemeChoices& choices)
      : hats_(choices.basis == Basis::smoothed_gradients ||
              (choices.basis == Basis::splines && state.grid.degree() == 1)) {
    const numerics::SplineSpace& grid = state.grid;
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
    for (std::size_t p = 0; p < data.size(); ++p, n += P + 1) {
      const auto first = static_cast<std::size_t>(state.basis.first[p]);
      const double x = middle(p);
      const double slope = state.particles.mass[p] * state.particles.velocity_gradient[p];
      for (std::size_t k = 0; k <= P; ++k) sums[first + k] += slope * (n[k] * (abscissa_[first + k] - x));
    }
  }

  /// c_p = Σ N_i v_i (x_i − x_p) / Σ N_i (x_i − x_p)², which is Σ N_i′ v_i for hat functions.
  void take_gradient(State& state) const {
    auto& gradient = state.particles.velocity_gradient;
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

 private:
  bool hats_;  ///< the values are those of hat functions, whose Σ N_i (x_i − x_p)² vanishes at the nodes
  std::vector<double> abscissa_;
};

template <int P>
void join_transfer(PlanBuilder& builder, const std::shared_ptr<AffineVelocity<P>>& affine) {
  const SchemeChoices& choices = builder.scene.scheme.choices;
  switch (choices.transfer) {
    case Transfer::flip:
      if (const double fraction = choices.flip_fraction; fraction < 1.0)
        join_velocity_change(builder, "particle velocity (FLIP and PIC)",
                             [fraction](State& state) { mix_velocity<P>(state, fraction); });
      return;
    case Transfer::pic:
      return join_velocity_change(builder, "particle velocity (PIC)", take_velocity<P>);
    case Transfer::xpic:
      return join_velocity_change(
          builder, "particle velocity (XPIC)",
          [hidden = std::make_shared<HiddenVelocity<P>>(builder)](State& state) { hidden->remove(state); },
          "per particle: hidden velocity; per function: its projection");
    case Transfer::apic:
      builder.add(
          Phase::velocity, "gradient of the particle velocity (APIC)",
          [affine](State& state) { affine->take_gradient(state); }, "per function: abscissa");
      join_velocity_change(builder, "particle velocity (PIC)", take_velocity<P>);
  }
}

}  // namespace hompm::detail
