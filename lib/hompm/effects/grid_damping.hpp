// What all dampings on the grid have in common: a force per function, and the energy it takes.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <hompm/plan/plan.hpp>

namespace hompm::detail {

/// Adds `force_of(momentum, force, velocity)` (Pa) to the force on every grid function, where `force` is of
/// the field of that name and `velocity` that of the last projection; `reads` are those that it takes. Books
/// its impulse, and the energy −f·v Δt it takes once the velocity of the step is known.
template <class Force>
void join_grid_damping(const PlanBuilder& builder, const std::string& name, const Fields& reads, Field force,
                       Force force_of) {
  const Field damping = builder.field({"damping_force", "Pa", "of " + name, Site::function});
  builder.add({.name = name,
               .phase = Phase::damping_force,
               .reads = reads,
               .changes = {"grid.force"_field, "balance.impulse"_field},
               .writes = {damping},
               .run = [=](State& state) {
                 GridFields& g = state.fields;
                 const auto& of_function = state[force];
                 auto& own = state[damping];
                 double sum = 0.0;
                 for (std::size_t i = 0; i < own.size(); ++i) {
                   const double f = force_of(g.momentum[i], of_function[i], g.velocity[i]);
                   own[i] = f;
                   g.force[i] += f;
                   sum += f;
                 }
                 state.balance.impulse += state.kick * sum;
               }});
  builder.add({.name = name + ": dissipated energy",
               .phase = Phase::work,
               .reads = {damping, "grid.velocity"_field},
               .changes = {"balance.dissipated"_field},
               .run = [damping](State& state) {
                 const auto& own = state[damping];
                 double power = 0.0;
                 for (std::size_t i = 0; i < own.size(); ++i) power += own[i] * state.fields.velocity[i];
                 state.balance.dissipated -= state.drift * power;
               }});
}

}  // namespace hompm::detail
