#include <algorithm>
#include <array>

#include <hompm/effects/amplitude_parameters.hpp>
#include <hompm/effects/effects.hpp>
#include <hompm/scene/amplitude.hpp>

namespace hompm::detail {
namespace {

/// f_i = n t N_i(x_end) at the material boundary, with the outward normal n = ±1 (Tielen et al. 2017, section
/// 2).
void join(const EffectSpec& spec, const PlanBuilder& builder) {
  const bool right = spec.text("end") == "right";
  const double force = right ? spec.number("value") : -spec.number("value");
  const Amplitude amplitude = amplitude_of(spec);

  const auto at_end = [right](const State& state, auto visit) {
    std::array<double, 6> values{};
    std::array<double, 6> gradients{};
    const auto at = state.grid.locate(right ? state.right_boundary : state.left_boundary);
    state.grid.evaluate(at, values, gradients);
    for (int k = 0; k <= state.grid.degree(); ++k)
      visit(static_cast<std::size_t>(at.cell) + static_cast<std::size_t>(k),
            values[static_cast<std::size_t>(k)]);
  };
  const Field boundary = right ? "right_boundary"_field : "left_boundary"_field;
  if (builder.has_markers())
    builder.add({.name = "traction: stress at the end",
                 .phase = Phase::end_stress,
                 .changes = {right ? "right_stress"_field : "left_stress"_field},
                 .run = [right, stress = spec.number("value"), amplitude](State& state) {
                   (right ? state.right_stress : state.left_stress) +=
                       stress * amplitude(state.position_time);
                 }});
  builder.add({.name = "traction",
               .phase = Phase::external_force,
               .reads = {boundary},
               .changes = {"grid.force"_field, "balance.impulse"_field},
               .run = [at_end, force, amplitude](State& state) {
                 const double now = force * amplitude(state.position_time);
                 at_end(state, [&](std::size_t i, double value) { state.fields.force[i] += now * value; });
                 state.balance.impulse += state.kick * now;
               }});
  builder.add({.name = "traction: external work",
               .phase = Phase::work,
               .reads = {boundary, "grid.velocity"_field},
               .changes = {"balance.external_work"_field},
               .run = [at_end, force, amplitude](State& state) {
                 double velocity = 0.0;
                 at_end(state,
                        [&](std::size_t i, double value) { velocity += value * state.fields.velocity[i]; });
                 const double middle = state.position_time + 0.5 * state.drift;
                 state.balance.external_work += state.drift * force * amplitude(middle) * velocity;
               }});
}

/// Of a body that it stretches, or speeds up as a whole, whichever is less.
LoadOutlook outlook(const EffectSpec& spec, const Scene& scene) {
  const double stress = spec.number("value");
  const double momentum = stress * scene.end_time;
  const auto& material = scene.material;
  const double length = scene.body.length;
  return {.settled_from = stress == 0.0 ? 0.0 : amplitude_of(spec).settled_from(),
          .energy = std::min(stress * (stress / material.youngs_modulus) * length,
                             momentum * (momentum / (2.0 * material.density * length)))};
}

}  // namespace

EffectType traction() {
  return {.name = "traction",
          .meaning = "stress on a free end: from t = 0, ramped up, oscillating, or a pulse",
          .parameters = with_amplitude(
              {{.name = "value", .unit = "Pa", .meaning = "stress at the end, tension positive"},
               {.name = "end",
                .unit = "",
                .meaning = "which end",
                .words = {"left", "right"},
                .default_value = "right"}}),
          .join = join,
          .outlook = outlook};
}

}  // namespace hompm::detail
