#include <limits>

#include <hompm/effects/amplitude_parameters.hpp>
#include <hompm/effects/body_end.hpp>
#include <hompm/effects/effects.hpp>
#include <hompm/scene/amplitude.hpp>

namespace hompm::detail {
namespace {

/// The end moves with v(t) a(t): J = (v a − v_e)/w, with a in the middle of the drift.
void join(const EffectSpec& spec, const PlanBuilder& builder) {
  const Side side = side_of(spec);
  const double velocity = spec.number("velocity");
  const Amplitude amplitude = amplitude_of(spec);
  join_own_stress(side, builder);
  const BodyEnd end(builder, side);
  builder.add(end.stage("piston", [velocity, amplitude, end](State& state) {
    const auto response = end.find(state);
    const double wanted = velocity * amplitude(state.position_time + 0.5 * state.drift);
    const double impulse = (wanted - response.velocity) / response.compliance;
    state.balance.external_work += end.push(state, response, impulse);
  }));
}

/// Of a body with its velocity, and with the strain of a wave that brings it.
LoadOutlook outlook(const EffectSpec& spec, const Scene& scene) {
  const double velocity = spec.number("velocity");
  const Amplitude amplitude = amplitude_of(spec);
  const bool moves_on = velocity != 0.0 && amplitude.final() != 0.0;
  return {.settled_from = moves_on          ? std::numeric_limits<double>::infinity()
                          : velocity == 0.0 ? 0.0
                                            : amplitude.settled_from(),
          .energy = scene.material.density * scene.body.length * velocity * velocity};
}

}  // namespace

EffectType piston() {
  return {.name = "piston",
          .meaning = "prescribed velocity of a free end: from t = 0, ramped up, oscillating, or a pulse",
          .parameters = with_amplitude(
              {{.name = "velocity", .unit = "m/s", .meaning = "of the end, in the direction of X"},
               which_end("left")}),
          .join = join,
          .conflict = conflict_of_held_end,
          .outlook = outlook,
          .holds_end = true,
          .join_linear = join_standing_end};
}

}  // namespace hompm::detail
