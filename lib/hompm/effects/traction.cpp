#include <array>

#include <hompm/effects/effects.hpp>

namespace hompm::detail {
namespace {

/// f_i = n t N_i(x_end) at the material boundary, with the outward normal n = ±1 (Tielen et al. 2017, section
/// 2).
void join(const EffectSpec& spec, PlanBuilder& builder) {
  const bool right = spec.text("end") == "right";
  const double force = right ? spec.number("value") : -spec.number("value");

  const auto at_end = [right](const State& state, auto visit) {
    std::array<double, 6> values{};
    std::array<double, 6> gradients{};
    const auto at = state.grid.locate(right ? state.right_boundary : state.left_boundary);
    state.grid.evaluate(at, values, gradients);
    for (int k = 0; k <= state.grid.degree(); ++k)
      visit(static_cast<std::size_t>(at.cell) + static_cast<std::size_t>(k),
            values[static_cast<std::size_t>(k)]);
  };
  if (builder.wants_end_stress)
    builder.add(Phase::end_stress, "traction: stress at the end",
                [right, stress = spec.number("value")](State& state) {
                  (right ? state.right_stress : state.left_stress) += stress;
                });
  builder.add(Phase::external_force, "traction", [at_end, force](State& state) {
    at_end(state, [&](std::size_t i, double value) { state.fields.force[i] += force * value; });
    state.balance.impulse += state.kick * force;
  });
  builder.add(Phase::work, "traction: external work", [at_end, force](State& state) {
    double velocity = 0.0;
    at_end(state, [&](std::size_t i, double value) { velocity += value * state.fields.velocity[i]; });
    state.balance.external_work += state.drift * force * velocity;
  });
}

}  // namespace

EffectType traction() {
  return {.name = "traction",
          .meaning = "constant stress on a free end, switched on at t = 0",
          .parameters = {{.name = "value", .unit = "Pa", .meaning = "stress at the end, tension positive"},
                         {.name = "end",
                          .unit = "",
                          .meaning = "which end",
                          .words = {"left", "right"},
                          .default_value = "right"}},
          .join = join};
}

}  // namespace hompm::detail
