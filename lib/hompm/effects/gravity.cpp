#include <hompm/effects/effects.hpp>
#include <hompm/numerics/smooth_step.hpp>

namespace hompm::detail {
namespace {

void apply(State& state, double b) {
  GridFields& g = state.fields;
  for (std::size_t i = 0; i < g.force.size(); ++i) g.force[i] += b * g.mass[i];
  state.balance.impulse += state.kick * b * state.total_mass;
}

/// Changes with time, so that it has no potential: what it does is external work.
void join_ramped(double b, double ramp_time, PlanBuilder& builder) {
  builder.add(Phase::external_force, "gravity, ramped", [b, ramp_time](State& state) {
    apply(state, b * numerics::ramp(state.position_time, ramp_time));
  });
  builder.add(Phase::work, "gravity, ramped: external work", [b, ramp_time](State& state) {
    const Particles& p = state.particles;
    double momentum = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) momentum += p.mass[i] * p.velocity[i];
    const double middle = state.position_time + 0.5 * state.drift;
    state.balance.external_work += state.drift * b * numerics::ramp(middle, ramp_time) * momentum;
  });
}

/// f_i = b Σ_p m_p N_i(x_p) = b M_i, potential −b Σ m u (Tielen et al. 2017, section 2).
void join(const EffectSpec& spec, PlanBuilder& builder) {
  const double b = spec.number("acceleration");
  if (const double ramp_time = spec.number("ramp_time"); ramp_time > 0.0)
    return join_ramped(b, ramp_time, builder);
  builder.add(Phase::external_force, "gravity", [b](State& state) { apply(state, b); });
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
          .meaning = "constant body force, switched on at t = 0 or ramped up",
          .parameters = {{.name = "acceleration",
                          .unit = "m/s^2",
                          .meaning = "in the direction of X; -9.81 pulls a column down"},
                         {.name = "ramp_time",
                          .unit = "s",
                          .meaning = "until it acts in full, with four continuous derivatives; 0: at once",
                          .minimum = 0.0,
                          .default_value = 0.0}},
          .join = join};
}

}  // namespace hompm::detail
