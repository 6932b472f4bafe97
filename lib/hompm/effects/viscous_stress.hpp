// What all viscosities have in common: a stress per particle beside that of the law, and the energy it takes.
#pragma once

#include <string>

#include <hompm/plan/plan.hpp>

namespace hompm::detail {

/// Adds `stress_of(state, particle, ∂v/∂x)` (Pa) to the total stress of every particle; ∂v/∂x is that of the
/// grid velocity of the last projection. Books the energy Σ V q ∂v/∂x Δt it takes, ∂v/∂x of the drift under
/// way. For effects whose row has `adds_stress`.
template <class StressOf>
void join_viscous_stress(const PlanBuilder& builder, const std::string& name, StressOf stress_of) {
  const Field rate = builder.field({"strain_rate", "1/s", "∂v/∂x of the grid velocity, for " + name});
  const Field added = builder.field({"viscous_stress", "Pa", "of " + name});
  const Field total = builder.plan.total_stress;
  const auto& grid = builder.discretisation;
  Fields reads = grid->reads();
  reads.insert(reads.end(), {"grid.velocity"_field, "particles.stretch"_field});
  builder.add({.name = name,
               .phase = Phase::total_stress,
               .reads = reads,
               .changes = {total},
               .writes = {rate, added},
               .run = [=](State& state) {
                 auto& v = state[rate];
                 auto& q = state[added];
                 auto& stress = state[total];
                 grid->velocity_gradient(state, v);
                 for (std::size_t p = 0; p < v.size(); ++p) {
                   q[p] = stress_of(state, p, v[p]);
                   stress[p] += q[p];
                 }
               }});
  builder.add({.name = name + ": dissipated energy",
               .phase = Phase::work,
               .reads = {"particles.volume"_field, "grid.velocity"_field, added},
               .changes = {rate, "balance.dissipated"_field},
               .run = [=](State& state) {
                 auto& v = state[rate];
                 const auto& q = state[added];
                 grid->velocity_gradient(state, v);
                 double power = 0.0;
                 for (std::size_t p = 0; p < v.size(); ++p) power += state.particles.volume[p] * q[p] * v[p];
                 state.balance.dissipated += state.drift * power;
               }});
}

/// For `EffectType::conflict` of all viscosities.
inline std::string needs_forward_kicks(const EffectSpec& /*spec*/, const Scene& scene) {
  if (scene.scheme.choices.time_integrator != TimeIntegrator::blanes_moan) return "";
  return "a viscosity cannot be run by the kicks backwards in time of blanes-moan: "
         "`scheme.time_integrator` must be \"euler-cromer\" or \"leapfrog\"";
}

}  // namespace hompm::detail
