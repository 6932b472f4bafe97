// What all dampings on the grid have in common: a force per function, and the energy it takes.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <hompm/plan/plan.hpp>

namespace hompm::detail {

/// Adds `force_of(momentum, force, velocity)` (Pa) to the force on every grid function, where `force` is out
/// of balance so far and `velocity` is that of the last projection; books its impulse, and the energy −f·v Δt
/// it takes once the velocity of the step is known. A function that is carried along by others (a free end
/// with extension) has no force out of balance of its own: what acts on it acts on them.
template <class Force>
void join_grid_damping(PlanBuilder& builder, const std::string& name, Force force_of) {
  const auto damping = std::make_shared<std::vector<double>>(builder.state.fields.force.size());
  const auto out_of_balance = std::make_shared<std::vector<double>>(damping->size());
  builder.add(
      Phase::damping_force, name,
      [damping, out_of_balance, untie = builder.untie, force_of](State& state) {
        GridFields& g = state.fields;
        *out_of_balance = g.force;
        if (untie) untie(*out_of_balance);
        double sum = 0.0;
        for (std::size_t i = 0; i < damping->size(); ++i) {
          const double f = force_of(g.momentum[i], (*out_of_balance)[i], g.velocity[i]);
          (*damping)[i] = f;
          g.force[i] += f;
          sum += f;
        }
        state.balance.impulse += state.kick * sum;
      },
      "per function: damping force, force out of balance");
  builder.add(Phase::work, name + ": dissipated energy", [damping](State& state) {
    double power = 0.0;
    for (std::size_t i = 0; i < damping->size(); ++i) power += (*damping)[i] * state.fields.velocity[i];
    state.balance.dissipated -= state.drift * power;
  });
}

}  // namespace hompm::detail
