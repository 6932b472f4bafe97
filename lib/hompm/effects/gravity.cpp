#include <algorithm>
#include <string>

#include <hompm/effects/amplitude_parameters.hpp>
#include <hompm/effects/effects.hpp>
#include <hompm/scene/amplitude.hpp>

namespace hompm::detail {
namespace {

void apply(State& state, double b) {
  GridFields& g = state.fields;
  for (std::size_t i = 0; i < g.force.size(); ++i) g.force[i] += b * g.mass[i];
  state.balance.impulse += state.kick * b * state.total_mass;
}

template <class Run>
void add_force(const PlanBuilder& builder, const std::string& name, Run run) {
  builder.add({.name = name,
               .phase = Phase::external_force,
               .reads = {"grid.mass"_field},
               .changes = {"grid.force"_field, "balance.impulse"_field},
               .run = run});
}

/// Changes with time, so that it has no potential: what it does is external work.
void join_changing(double b, const Amplitude& amplitude, const std::string& name,
                   const PlanBuilder& builder) {
  add_force(builder, name,
            [b, amplitude](State& state) { apply(state, b * amplitude(state.position_time)); });
  builder.add({.name = name + ": external work",
               .phase = Phase::work,
               .reads = {"particles.mass"_field, "particles.velocity"_field},
               .changes = {"balance.external_work"_field},
               .run = [b, amplitude](State& state) {
                 const Particles& p = state.particles;
                 double momentum = 0.0;
                 for (std::size_t i = 0; i < p.size(); ++i) momentum += p.mass[i] * p.velocity[i];
                 const double middle = state.position_time + 0.5 * state.drift;
                 state.balance.external_work += state.drift * b * amplitude(middle) * momentum;
               }});
}

/// f_i = b Σ_p m_p N_i(x_p) = b M_i, potential −b Σ m u (Tielen et al. 2017, section 2).
void join(const EffectSpec& spec, const PlanBuilder& builder) {
  const double b = spec.number("acceleration");
  const Amplitude amplitude = amplitude_of(spec);
  if (!amplitude.constant()) {
    const bool only_ramped = amplitude.final() == 1.0;
    return join_changing(b, amplitude, only_ramped ? "gravity, ramped" : "gravity, changing", builder);
  }
  add_force(builder, "gravity", [b](State& state) { apply(state, b); });
  builder.plan.potentials.push_back([b](const State& state) {
    double mass_times_displacement = 0.0;
    for (std::size_t p = 0; p < state.particles.size(); ++p)
      mass_times_displacement += state.particles.mass[p] * state.particles.displacement[p];
    return -b * mass_times_displacement;
  });
}

/// Of a body that it lays or hangs up, or lets fall, whichever is less.
LoadOutlook outlook(const EffectSpec& spec, const Scene& scene) {
  const double b = spec.number("acceleration");
  const auto& [length, start] = scene.body;
  const double mass = scene.material.density * length;
  const double speed = b * scene.end_time;
  return {.settled_from = b == 0.0 ? 0.0 : amplitude_of(spec).settled_from(),
          .energy = std::min(mass * b * (mass * b / scene.material.youngs_modulus) * length,
                             0.5 * mass * speed * speed)};
}

}  // namespace

EffectType gravity() {
  return {.name = "gravity",
          .meaning = "body force: from t = 0, ramped up, oscillating, or a pulse",
          .parameters = with_amplitude({{.name = "acceleration",
                                         .unit = "m/s^2",
                                         .meaning = "in the direction of X; -9.81 pulls a column down"}}),
          .join = join,
          .outlook = outlook};
}

}  // namespace hompm::detail
