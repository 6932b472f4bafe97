// From forces to the grid velocity, and what particles keep of it.
#pragma once

#include <memory>

#include <hompm/plan/plan.hpp>
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
void join_acceleration(PlanBuilder& builder, const std::shared_ptr<Reconstruction>& splines) {
  if (builder.scene.scheme.choices.acceleration_mass == MassForm::lumped) {
    builder.add(Phase::acceleration, "grid acceleration, lumped mass", accelerate_lumped);
    builder.divide_by_mass = divide_impulses;
  } else {
    builder.add(Phase::acceleration, "grid acceleration, consistent mass", [splines](State& state) {
      state.fields.acceleration = state.fields.force;
      state.balance.impulse += state.kick * splines->solve(state.fields.acceleration);
    });
    builder.divide_by_mass = [splines](const State&, std::vector<double>& field) {
      return splines->solve(field);
    };
    builder.untie = [splines](std::vector<double>& force) { splines->untie(force); };
  }
  builder.add(Phase::acceleration, "particle velocity (FLIP)", [](State& state) {
    add_at_particles<P>(state, state.kick, state.fields.acceleration, state.particles.velocity);
  });
}

/// Of the impulses that hold fixed ends in the projection, the share that the particles take with the
/// velocity of the grid.
inline double share_of_reaction(const SchemeChoices& choices) {
  switch (choices.transfer) {
    case Transfer::flip:
      return 1.0 - choices.flip_fraction;
    case Transfer::xpic:
      return 0.0;  // the filter books its own
    default:
      return 1.0;
  }
}

/// The projection of particle data to the grid.
template <int P>
void join_projection(PlanBuilder& builder, const std::shared_ptr<Reconstruction>& splines,
                     const std::shared_ptr<LeastSquares<P>>& least_squares,
                     const std::shared_ptr<AffineVelocity<P>>& affine) {
  if (affine) {
    builder.project = [affine](const State& state, const auto& data, auto& field) {
      affine->sum_momentum(state, data, field);
      return velocity_of(state, field, field);
    };
    return;
  }
  switch (builder.scene.scheme.choices.velocity_projection) {
    case VelocityProjection::lumped:
      builder.project = [](const State& state, const auto& data, auto& field) {
        sum_weighted<P>(state, data, field);
        return velocity_of(state, field, field);
      };
      return;
    case VelocityProjection::consistent:
      builder.project = [splines](const State& state, const auto& data, auto& field) {
        splines->weighted_integrals(state, data, field);
        splines->solve(field);
        return 0.0;
      };
      return;
    case VelocityProjection::least_squares:
      builder.project = [least_squares](const State& state, const auto& data, auto& field) {
        return least_squares->project(state, data, field);
      };
  }
}

/// MUSL: the particles, which the forces have pushed, say how fast the grid is.
template <int P>
void join_velocity_of_particles(PlanBuilder& builder, const std::shared_ptr<Reconstruction>& splines) {
  const double share = share_of_reaction(builder.scene.scheme.choices);
  switch (builder.scene.scheme.choices.velocity_projection) {
    case VelocityProjection::lumped:
      if (share > 0.0)
        builder.add(Phase::velocity, "grid velocity, lumped mass",
                    [share](State& state) { state.balance.impulse += share * project_lumped<P>(state); });
      else
        builder.add(Phase::velocity, "grid velocity, lumped mass", project_lumped<P>);
      return;
    case VelocityProjection::consistent:
      builder.add(Phase::velocity, "grid velocity, consistent mass", [splines](State& state) {
        GridFields& g = state.fields;
        splines->weighted_integrals(state, state.particles.velocity, g.momentum);
        g.velocity = g.momentum;
        splines->solve(g.velocity);
      });
      return;
    case VelocityProjection::least_squares:
      builder.add(
          Phase::velocity, "grid velocity, least squares", [share, project = builder.project](State& state) {
            state.balance.impulse += share * project(state, state.particles.velocity, state.fields.velocity);
          });
  }
}

/// USL and USF: v_i = P(v_p − κ Σ N_j a_j)_i + κ a_i. The velocities before the kick go to the grid, which
/// takes the kick whole.
template <int P>
void join_velocity_after_kick(PlanBuilder& builder) {
  const auto before = std::make_shared<std::vector<double>>(builder.state.particles.size());
  builder.add(
      Phase::velocity, "grid velocity before the kick, and the kick",
      [before, share = share_of_reaction(builder.scene.scheme.choices),
       project = builder.project](State& state) {
        *before = state.particles.velocity;
        GridFields& g = state.fields;
        add_at_particles<P>(state, -state.kick, g.acceleration, *before);
        state.balance.impulse += share * project(state, *before, g.velocity);
        for (std::size_t i = 0; i < g.velocity.size(); ++i) g.velocity[i] += state.kick * g.acceleration[i];
      },
      "per particle: velocity before the kick");
}

/// How ∫ρ v N_i of the grid velocity is found where the projection has not summed it up.
template <int P>
void join_momentum(PlanBuilder& builder, const std::shared_ptr<Reconstruction>& splines) {
  const SchemeChoices& choices = builder.scene.scheme.choices;
  const bool least_squares = choices.velocity_projection == VelocityProjection::least_squares;
  if (!least_squares && choices.sequence == Sequence::musl) return;
  if (needs_density(choices))
    builder.update_momentum = [splines](State& state) {
      splines->momentum(state.fields.velocity, state.fields.momentum);
    };
  else if (least_squares)
    builder.update_momentum = sum_momentum<P>;
  else
    builder.update_momentum = [](State& state) {
      GridFields& g = state.fields;
      for (std::size_t i = 0; i < g.mass.size(); ++i) g.momentum[i] = g.mass[i] * g.velocity[i];
    };
}

template <int P>
void join_velocity(PlanBuilder& builder, const std::shared_ptr<Reconstruction>& splines,
                   const std::shared_ptr<AffineVelocity<P>>& affine) {
  join_acceleration<P>(builder, splines);
  if (builder.scene.scheme.choices.sequence == Sequence::musl)
    join_velocity_of_particles<P>(builder, splines);
  else
    join_velocity_after_kick<P>(builder);
  join_transfer<P>(builder, affine);
  join_momentum<P>(builder, splines);
}

}  // namespace hompm::detail
