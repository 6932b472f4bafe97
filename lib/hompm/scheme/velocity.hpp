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

/// Σ_p m_p v_p N_i
template <int P>
void sum_momentum(State& state) {
  auto& momentum = state.fields.momentum;
  std::fill(momentum.begin(), momentum.end(), 0.0);
  const Particles& particles = state.particles;
  scatter<P>(state, state.basis.values, momentum,
             [mass = particles.mass.data(), velocity = particles.velocity.data()](std::size_t p) {
               return mass[p] * velocity[p];
             });
}

/// v_i = Σ_p m_p v_p N_i / M_i; functions with no mass and fixed ends stand still.
template <int P>
void project_lumped(State& state) {
  sum_momentum<P>(state);
  GridFields& g = state.fields;
  divide_by_mass(g.momentum, g.mass, g.velocity);
  if (state.ends.left == End::fixed) g.velocity.front() = 0.0;
  if (state.ends.right == End::fixed) g.velocity.back() = 0.0;
}

double kinetic_energy(const Particles& particles);

template <int P>
void join_acceleration(PlanBuilder& builder, const std::shared_ptr<Reconstruction>& splines) {
  if (builder.scene.scheme.choices.acceleration_mass == MassForm::lumped) {
    builder.add(Phase::acceleration, "grid acceleration, lumped mass", accelerate_lumped);
  } else {
    builder.add(Phase::acceleration, "grid acceleration, consistent mass", [splines](State& state) {
      state.fields.acceleration = state.fields.force;
      state.balance.impulse += state.kick * splines->solve(state.fields.acceleration);
    });
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
      return;
    case VelocityProjection::consistent:
      builder.add(Phase::velocity, "grid velocity, consistent mass", [splines](State& state) {
        GridFields& g = state.fields;
        splines->weighted_integrals(state.particles.velocity, g.momentum);
        g.velocity = g.momentum;
        splines->solve(g.velocity);
      });
      return;
    case VelocityProjection::least_squares:
      builder.add(Phase::velocity, "grid velocity, least squares", [least_squares](State& state) {
        state.balance.impulse +=
            least_squares->project(state, state.particles.velocity, state.fields.velocity);
      });
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
