// From forces to the grid velocity, and what particles keep of it.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <hompm/scheme/least_squares.hpp>
#include <hompm/scheme/reconstruction.hpp>
#include <hompm/scheme/transfer.hpp>

namespace hompm::detail {

/// q_i / M_i; 0 for functions with no mass.
void divide_by_mass(const std::vector<double>& field, const std::vector<double>& mass,
                    std::vector<double>& quotient);

/// a_i = f_i / M_i; functions with no mass are inactive, and at a fixed end the reaction balances the force.
void accelerate_lumped(State& state);

/// Impulses over M_i, in place; nothing at fixed ends. Returns the impulses that hold these.
double divide_impulses(const State& state, std::vector<double>& field);

/// Σ_p m_p v_p N_i
template <int P>
void sum_momentum(State& state) {
  sum_weighted<P>(state, state.particles.velocity, state.fields.momentum);
}

/// The momenta of all functions, as Σ_p m_p q_p N_i, over M_i; functions with no mass and fixed ends stand
/// still. Returns the impulses that hold these, kg/(m s).
double velocity_of(const State& state, const std::vector<double>& momentum, std::vector<double>& velocity);

/// v_i = Σ_p m_p v_p N_i / M_i
template <int P>
double project_lumped(State& state) {
  sum_momentum<P>(state);
  return velocity_of(state, state.fields.momentum, state.fields.velocity);
}

template <int P>
void join_acceleration(const StageBuilder& builder, Own<Reconstruction> splines) {
  Stage stage{.name = "grid acceleration, lumped mass",
              .phase = Phase::acceleration,
              .reads = {"grid.force"_field, "grid.mass"_field},
              .changes = {"balance.impulse"_field},
              .writes = {"grid.acceleration"_field},
              .run = accelerate_lumped};
  if (builder.scheme.choices.acceleration_mass == MassForm::consistent) {
    stage.name = "grid acceleration, consistent mass";
    stage.reads[1] = splines.field;
    stage.run = [splines](State& state) {
      state.fields.acceleration = state.fields.force;
      state.balance.impulse += state.kick * splines.of(state).solve(state.fields.acceleration);
    };
  }
  builder.add(std::move(stage));
  builder.add({.name = "particle velocity (FLIP)",
               .phase = Phase::acceleration,
               .reads = {"basis.first"_field, "basis.values"_field, "grid.acceleration"_field},
               .changes = {"particles.velocity"_field},
               .run = [](State& state) {
                 add_at_particles<P>(state, state.kick, state.fields.acceleration, state.particles.velocity);
               }});
}

/// Of the impulses that hold fixed ends in the projection, the share that the particles take with the
/// velocity of the grid.
inline double share_of_reaction(const SchemeChoices& choices) {
  switch (choices.transfer) {
    case Transfer::flip: return 1.0 - choices.flip_fraction;
    case Transfer::xpic: return 0.0;  // the filter books its own
    default: return 1.0;
  }
}

/// What a scheme of splines or hat functions is: P + 1 functions reach a particle.
template <int P>
class Discretised final : public Discretisation {
 public:
  Discretised(const StageBuilder& builder, Own<Reconstruction> splines, Own<LeastSquares<P>> least_squares,
              std::shared_ptr<const AffineVelocity<P>> affine)
      : choices_(builder.scheme.choices),
        total_(builder.state.moves && !builder.state.basis_moves),
        splines_(splines),
        least_squares_(least_squares),
        affine_(std::move(affine)) {}

  double project(State& state, const std::vector<double>& particles,
                 std::vector<double>& grid) const override {
    switch (choices_.velocity_projection) {
      case VelocityProjection::lumped:
        if (affine_)
          affine_->sum_momentum(state, particles, grid);
        else
          sum_weighted<P>(state, particles, grid);
        return velocity_of(state, grid, grid);
      case VelocityProjection::consistent:
        splines_.of(state).weighted_integrals(state, particles, grid);
        splines_.of(state).solve(grid);
        return 0.0;
      default: return least_squares_.of(state).project(state, particles, grid);
    }
  }
  double divide_by_mass(State& state, std::vector<double>& impulses) const override {
    return choices_.acceleration_mass == MassForm::lumped ? divide_impulses(state, impulses)
                                                          : splines_.of(state).solve(impulses);
  }
  [[nodiscard]] bool ties() const override {
    return choices_.acceleration_mass == MassForm::consistent && choices_.free_end == FreeEnd::extension;
  }
  void untie(State& state, std::vector<double>& forces) const override { splines_.of(state).untie(forces); }
  [[nodiscard]] bool keeps_momentum() const override {
    return choices_.velocity_projection != VelocityProjection::least_squares &&
           choices_.sequence == Sequence::musl;
  }
  void find_momentum(State& state) const override {
    GridFields& g = state.fields;
    if (needs_density(choices_))
      splines_.of(state).momentum(g.velocity, g.momentum);
    else if (choices_.velocity_projection == VelocityProjection::least_squares)
      sum_momentum<P>(state);
    else
      for (std::size_t i = 0; i < g.mass.size(); ++i) g.momentum[i] = g.mass[i] * g.velocity[i];
  }
  void velocity_gradient(const State& state, std::vector<double>& gradient) const override {
    const Gather<P> at(state, state.basis.gradients, state.fields.velocity);
    for (std::size_t p = 0; p < gradient.size(); ++p) gradient[p] = at(p);
    if (!total_) return;
    for (std::size_t p = 0; p < gradient.size(); ++p) gradient[p] /= state.particles.stretch[p];
  }
  [[nodiscard]] Fields reads() const override {
    Fields fields{"particles.mass"_field, "basis.first"_field, "basis.values"_field, "basis.gradients"_field,
                  "grid.mass"_field};
    for (const Field field : {splines_.field, least_squares_.field, affine_ ? affine_->gradient() : Field{}})
      if (field) fields.push_back(field);
    return fields;
  }

 private:
  SchemeChoices choices_;
  bool total_;  ///< gradients are ∂/∂X: ∂v/∂x = (∂v/∂X)/λ
  Own<Reconstruction> splines_;
  Own<LeastSquares<P>> least_squares_;
  std::shared_ptr<const AffineVelocity<P>> affine_;
};

using SharedDiscretisation = std::shared_ptr<const Discretisation>;

/// MUSL: the particles, which the forces have pushed, say how fast the grid is.
template <int P>
void join_velocity_of_particles(const StageBuilder& builder, Own<Reconstruction> splines,
                                const SharedDiscretisation& discretisation) {
  const double share = share_of_reaction(builder.scheme.choices);
  Stage stage{.name = "",
              .phase = Phase::velocity,
              .reads = discretisation->reads(),
              .changes = {"balance.impulse"_field},
              .writes = {"grid.velocity"_field, "grid.momentum"_field},
              .run = {}};
  stage.reads.push_back("particles.velocity"_field);
  switch (builder.scheme.choices.velocity_projection) {
    case VelocityProjection::lumped:
      stage.name = "grid velocity, lumped mass";
      stage.run = project_lumped<P>;
      if (share > 0.0)
        stage.run = [share](State& state) { state.balance.impulse += share * project_lumped<P>(state); };
      break;
    case VelocityProjection::consistent:
      stage.name = "grid velocity, consistent mass";
      stage.run = [splines](State& state) {
        GridFields& g = state.fields;
        splines.of(state).weighted_integrals(state, state.particles.velocity, g.momentum);
        g.velocity = g.momentum;
        splines.of(state).solve(g.velocity);
      };
      break;
    case VelocityProjection::least_squares:
      stage.name = "grid velocity, least squares";
      stage.writes.pop_back();
      stage.run = [share, discretisation](State& state) {
        state.balance.impulse +=
            share * discretisation->project(state, state.particles.velocity, state.fields.velocity);
      };
  }
  builder.add(std::move(stage));
}

/// v_i = P(v_p − κ Σ N_j a_j)_i + κ a_i. The velocities before the kick go to the grid, which takes the kick
/// whole. Of the impulses that hold fixed ends `share` is booked.
template <int P>
void join_velocity_after_kick(const StageBuilder& builder, const SharedDiscretisation& discretisation,
                              Field grid_velocity, double share) {
  const Field before = builder.field({"velocity_before_kick", "m/s", "without the kick of the step"});
  Stage stage{.name = "grid velocity before the kick, and the kick",
              .phase = Phase::velocity,
              .reads = discretisation->reads(),
              .changes = {"balance.impulse"_field},
              .writes = {before, grid_velocity},
              .run = [=](State& state) {
                auto& velocity = state[before];
                velocity = state.particles.velocity;
                auto& target = state[grid_velocity];
                const auto& acceleration = state.fields.acceleration;
                add_at_particles<P>(state, -state.kick, acceleration, velocity);
                state.balance.impulse += share * discretisation->project(state, velocity, target);
                for (std::size_t i = 0; i < target.size(); ++i) target[i] += state.kick * acceleration[i];
              }};
  stage.reads.insert(stage.reads.end(), {"particles.velocity"_field, "grid.acceleration"_field});
  builder.add(std::move(stage));
}

/// Returns the grid velocity that moves the particles.
template <int P>
Field join_velocity(const StageBuilder& builder, Own<Reconstruction> splines,
                    const std::shared_ptr<const AffineVelocity<P>>& affine,
                    const SharedDiscretisation& discretisation) {
  join_acceleration<P>(builder, splines);
  const SchemeChoices& choices = builder.scheme.choices;
  Field moving = "grid.velocity"_field;
  if (choices.position_update == PositionUpdate::before_projection) {
    moving = builder.field({"moving_velocity", "m/s", "that moves the particles", Site::function});
    join_velocity_after_kick<P>(builder, discretisation, moving, 0.0);
  }
  if (choices.sequence == Sequence::musl)
    join_velocity_of_particles<P>(builder, splines, discretisation);
  else
    join_velocity_after_kick<P>(builder, discretisation, moving, share_of_reaction(choices));
  join_transfer<P>(builder, affine, discretisation);
  return moving;
}

}  // namespace hompm::detail
