#include <hompm/effects/body_end.hpp>
#include <hompm/effects/effects.hpp>
#include <hompm/number.hpp>
#include <hompm/plan/invalid.hpp>

namespace hompm::detail {
namespace {

/// `end` as the condition on it will see it, displaced.
void check_position(const EffectSpec& spec, const State& state, Side side, double position, double end) {
  const double length = state.right_boundary - state.left_boundary;
  if (outward(side) * (position - end) < -1e-9 * length)
    throw SceneError(spec.origin, "the wall at " + to_text(position) +
                                      " m is inside the body, whose end is at " + to_text(end) +
                                      " m at the start; `position` must be at " +
                                      (side == Side::right ? "least" : "most") + " that");
  if (state.basis_moves && state.grid.locate(position).cell < 0)
    throw SceneError(spec.origin, "the wall at " + to_text(position) + " m is off the grid, " +
                                      grid_text(state) + "; " + raise_grid);
}

/// The end may close the gap g to the wall within the drift, and no more: outward v_e ≤ g/δ, by an impulse
/// that pushes. A condition on velocities in the manner of J. J. Moreau (1988) that keeps the positions apart
/// too: there is no penetration, and no stiffness to choose.
void join(const EffectSpec& spec, const PlanBuilder& builder) {
  const Side side = side_of(spec);
  const double n = outward(side);
  const double position = spec.number("position");
  const Field total = builder.plan.total_stress;
  const BodyEnd end(builder, side);
  check_position(spec, builder.state, side, position, end.position(builder.state));
  const auto gap = [=](const State& state) { return n * (position - end.position(state)); };
  if (builder.has_markers())
    builder.add({.name = "wall: a marker in contact carries its own stress",
                 .phase = Phase::end_stress,
                 .reads = {"particles.displacement"_field, total},
                 .changes = {side == Side::right ? "right_stress"_field : "left_stress"_field},
                 .run = [=](State& state) { carry_contact_stress(state, total, side, gap(state)); }});
  builder.add(end.stage("wall", [=](State& state) {
    const double excess = n * end.velocity(state) - approach_limit(state, gap(state));
    if (!(excess > 0.0)) return;
    const auto response = end.find(state);
    state.balance.dissipated -= end.push(state, response, -n * excess / response.compliance);
  }));
  builder.plan.arrivals.push_back(
      [=](const State& state) { return arrival_of(state, gap(state), n * end.velocity(state)); });
}

}  // namespace

EffectType wall() {
  return {.name = "wall",
          .meaning = "rigid wall that a free end meets and leaves again",
          .parameters = {{.name = "position", .unit = "m", .meaning = "of the wall, beyond the end"},
                         which_end("right")},
          .join = join,
          .conflict = conflict_of_held_end,
          .holds_end = true,
          .join_linear = join_standing_end};
}

}  // namespace hompm::detail
