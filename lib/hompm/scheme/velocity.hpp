// From forces to the grid velocity, and what particles keep of it.
#pragma once

#include <memory>

#include <hompm/plan/plan.hpp>
#include <hompm/scheme/least_squares.hpp>
#include <hompm/scheme/reconstruction.hpp>

namespace hompm::detail {

/// q_i / M_i; 0 for functions with no mass.
void divide_by_mass(const std::vector<double>& field, const std::vector<double>& mass,
                    std::vector<double>& quotient);

/// a_i = f_i / M_i; functions with no mass are inactive, and at a fixed end the reaction balances the force.
void accelerate_lumped(State& state);

/// Impulses over M_i, in place; nothing at fixed ends. Returns the impulses that hold these.
double divide_impulses(const State& state, std::vector<double>& field);

/// Σ_p m_p q_p N_i
template <int P>
void sum_weighted(const State& state, const std::vector<double>& data, std::vector<double>& sums) {
  std::fill(sums.begin(), sums.end(), 0.0);
  scatter<P>(state, state.basis.values, sums,
             [mass = state.particles.mass.data(), q = data.data()](std::size_t p) { return mass[p] * q[p]; });
}

/// Σ_p m_p v_p N_i
template <int P>
void sum_momentum(State& state) {
  sum_weighted<P>(state, state.particles.velocity, state.fields.momentum);
}

/// The momenta of all functions, as Σ_p m_p q_p N_i, over M_i; functions with no mass and fixed ends stand
/// still.
void velocity_of(const State& state, const std::vector<double>& momentum, std::vector<double>& velocity);

/// v_i = Σ_p m_p v_p N_i / M_i
template <int P>
void project_lumped(State& state) {
  sum_momentum<P>(state);
  velocity_of(state, state.fields.momentum, state.fields.velocity);
}

double kinetic_energy(const Particles& particles);

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
  }
  builder.add(Phase::acceleration, "particle velocity (FLIP)", [](State& state) {
    add_at_particles<P>(state, state.kick, state.fields.acceleration, state.particles.velocity);
  });
}

template <int P>
void join_projection(PlanBuilder& builder, const std::shared_ptr<Reconstruction>& splines,
                     const std::shared_ptr<LeastSquares<P>>& least_squares) {
  switch (builder.scene.scheme.choices.velocity_projection) {
    case VelocityProjection::lumped:
      builder.add(Phase::velocity, "grid velocity, lumped mass", project_lumped<P>);
      builder.project = [](const State& state, const auto& data, auto& field) {
        sum_weighted<P>(state, data, field);
        velocity_of(state, field, field);
      };
      return;
    case VelocityProjection::consistent:
      builder.add(Phase::velocity, "grid velocity, consistent mass", [splines](State& state) {
        GridFields& g = state.fields;
        splines->weighted_integrals(state.particles.velocity, g.momentum);
        g.velocity = g.momentum;
        splines->solve(g.velocity);
      });
      builder.project = [splines](const State&, const auto& data, auto& field) {
        splines->weighted_integrals(data, field);
        splines->solve(field);
      };
      return;
    case VelocityProjection::least_squares:
      builder.add(Phase::velocity, "grid velocity, least squares", [least_squares](State& state) {
        state.balance.impulse +=
            least_squares->project(state, state.particles.velocity, state.fields.velocity);
      });
      builder.project = [least_squares](const State& state, const auto& data, auto& field) {
        least_squares->project(state, data, field);
      };
  }
}

/// v_p = Σ N_i v_i: nothing of the particle velocity is hidden from the grid. What that takes of Σ ½ m v² is
/// booked as dissipated.
template <int P>
void join_pic(PlanBuilder& builder) {
  builder.add(Phase::velocity, "particle velocity (PIC)", [](State& state) {
    Particles& particles = state.particles;
    const double before = kinetic_energy(particles);
    const std::size_t count = particles.size();
    double* velocity = particles.velocity.data();
    const Gather<P> projected(state, state.basis.values, state.fields.velocity);
    for (std::size_t p = 0; p < count; ++p) velocity[p] = projected(p);
    state.balance.dissipated += before - kinetic_energy(particles);
  });
}

template <int P>
void join_velocity(PlanBuilder& builder, const std::shared_ptr<Reconstruction>& splines,
                   const std::shared_ptr<LeastSquares<P>>& least_squares) {
  const SchemeChoices& choices = builder.scene.scheme.choices;
  join_acceleration<P>(builder, splines);
  join_projection<P>(builder, splines, least_squares);
  if (choices.transfer == Transfer::pic) join_pic<P>(builder);
  if (choices.velocity_projection != VelocityProjection::least_squares) return;
  if (choices.acceleration_mass == MassForm::consistent)
    builder.update_momentum = [splines](State& state) {
      splines->momentum(state.fields.velocity, state.fields.momentum);
    };
  else
    builder.update_momentum = sum_momentum<P>;
}

}  // namespace hompm::detail
