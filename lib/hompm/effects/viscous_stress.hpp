// What all viscosities have in common: a stress per particle beside that of the law, and the energy it takes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <hompm/plan/plan.hpp>

namespace hompm::detail {

/// Keeps the stress of the law while that of effects is added to it for the internal force. The markers at
/// free ends carry what is applied there, and keep it.
inline void keep_law_stress(PlanBuilder& builder) {
  if (builder.law_stress) return;
  const auto kept = std::make_shared<std::vector<double>>(builder.state.particles.stress);
  builder.law_stress = kept;
  builder.add(
      Phase::end_stress, "stress of the law, kept", [kept](State& state) { *kept = state.particles.stress; },
      "per particle: stress of the law");
  builder.add(Phase::internal_force, "stress of the law again", [kept](State& state) {
    auto& stress = state.particles.stress;
    if (state.particles.markers > 0 && state.ends.left == End::free) kept->front() = stress.front();
    if (state.particles.markers > 0 && state.ends.right == End::free) kept->back() = stress.back();
    stress = *kept;
  });
}

/// Adds `stress_of(state, particle, ∂v/∂x)` (Pa) to the stress of every particle; ∂v/∂x is that of the grid
/// velocity of the last projection. Books the energy Σ V q ∂v/∂x Δt it takes, ∂v/∂x of the drift under way.
template <class StressOf>
void join_viscous_stress(PlanBuilder& builder, const std::string& name, StressOf stress_of) {
  keep_law_stress(builder);
  const auto rate = std::make_shared<std::vector<double>>(builder.state.particles.size());
  const auto added = std::make_shared<std::vector<double>>(builder.state.particles.size());
  const auto gradient = builder.velocity_gradient;
  builder.add(
      Phase::end_stress, name,
      [=](State& state) {
        gradient(state, *rate);
        for (std::size_t p = 0; p < rate->size(); ++p) {
          (*added)[p] = stress_of(state, p, (*rate)[p]);
          state.particles.stress[p] += (*added)[p];
        }
      },
      "per particle: velocity gradient, stress");
  builder.add(Phase::work, name + ": dissipated energy", [=](State& state) {
    gradient(state, *rate);
    double power = 0.0;
    for (std::size_t p = 0; p < rate->size(); ++p)
      power += state.particles.volume[p] * (*added)[p] * (*rate)[p];
    state.balance.dissipated += state.drift * power;
  });
  builder.plan.extra_stresses.push_back([=](const State& state, std::vector<double>& stress) {
    gradient(state, *rate);
    for (std::size_t p = 0; p < rate->size(); ++p) stress[p] += stress_of(state, p, (*rate)[p]);
  });
}

/// For `EffectType::conflict` of all viscosities.
inline std::string needs_forward_kicks(const EffectSpec& /*spec*/, const Scene& scene) {
  if (scene.scheme.choices.time_integrator != TimeIntegrator::blanes_moan) return "";
  return "a viscosity cannot be run by the kicks backwards in time of blanes-moan: "
         "`scheme.time_integrator` must be \"euler-cromer\" or \"leapfrog\"";
}

}  // namespace hompm::detail
