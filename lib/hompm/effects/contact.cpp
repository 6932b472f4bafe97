#include <string>
#include <utility>

#include <hompm/effects/body_end.hpp>
#include <hompm/effects/effects.hpp>
#include <hompm/number.hpp>

namespace hompm::detail {
namespace {

/// Two ends that may close the gap g between them within the drift, and no more: v_A − v_B ≤ g/δ, by an
/// impulse that pushes them apart (as wall.cpp, with the compliance of both).
void join(const EffectSpec& spec, const PairBuilder& pair) {
  const EndPair ends(pair);
  const double start = ends.gap(pair.left.state, pair.right.state);
  if (start < -1e-9 * pair.left.scene.body.length)
    throw SceneError(spec.origin, "the bodies " + std::to_string(pair.index) + " and " +
                                      std::to_string(pair.index + 1) + " overlap by " + to_text(-start) +
                                      " m");
  const Field a = pair.left.plan.total_stress, b = pair.right.plan.total_stress;
  if (pair.left.has_markers())
    pair.add({.name = "contact: markers in contact carry their own stress",
              .phase = Phase::end_stress,
              .reads = {Fields{a, "particles.displacement"_field}, Fields{b, "particles.displacement"_field}},
              .changes = {Fields{"right_stress"_field}, Fields{"left_stress"_field}},
              .run = [ends, a, b](State& left, State& right) {
                const double gap = ends.gap(left, right);
                carry_contact_stress(left, a, Side::right, gap);
                carry_contact_stress(right, b, Side::left, gap);
              }});
  Coupling contact = ends.coupling("contact", [ends](State& left, State& right) {
    const double most = approach_limit(left, ends.gap(left, right));
    const double excess = ends.closing_velocity(left, right) - most;
    if (excess > 0.0) left.balance.dissipated -= ends.slow_down(left, right, excess);
  });
  contact.arrival = [ends](const State& left, const State& right) {
    return arrival_of(left, ends.gap(left, right), ends.closing_velocity(left, right));
  };
  pair.add(std::move(contact));
}

}  // namespace

EffectType contact() {
  return {.name = "contact",
          .meaning = "the right end of a body and the left end of the next meet, push, and part again",
          .parameters = {},
          .join = nullptr,
          .conflict = conflict_of_held_end,
          .holds_end = true,
          .join_linear = join_coupled_end,
          .join_pair = join};
}

}  // namespace hompm::detail
