#include <hompm/effects/effects.hpp>

namespace hompm::detail {
namespace {

/// f_i = b Σ_p m_p N_i(x_p) = b M_i, potential −b Σ m u (Tielen et al. 2017, section 2).
void join(const EffectSpec& spec, PlanBuilder& builder) {
  const double b = spec.number("acceleration");
  builder.add(Phase::external_force, "gravity", [b](State& state) {
    GridFields& g = state.fields;
    for (std::size_t i = 0; i < g.force.size(); ++i) g.force[i] += b * g.mass[i];
    state.balance.impulse += state.kick * b * state.total_mass;
  });
  builder.plan.potentials.push_back([b](const State& state) {
    double moment = 0.0;
    for (std::size_t p = 0; p < state.particles.size(); ++p)
      moment += state.particles.mass[p] * state.particles.displacement[p];
    return -b * moment;
  });
}

}  // namespace

EffectType gravity() {
  return {.name = "gravity",
          .meaning = "constant body force, switched on at t = 0",
          .parameters = {{.name = "acceleration",
                          .unit = "m/s^2",
                          .meaning = "in the direction of X; -9.81 pulls a column down"}},
          .join = join};
}

}  // namespace hompm::detail
