#include <memory>

#include <hompm/effects/body_end.hpp>
#include <hompm/effects/effects.hpp>
#include <hompm/error.hpp>
#include <hompm/number.hpp>

namespace hompm::detail {
namespace {

/// Two ends that may close the gap g between them within the drift, and no more: v_A − v_B ≤ g/δ, by an
/// impulse that pushes them apart (as wall.cpp, with the compliance of both).
void join(const EffectSpec& spec, const PairBuilder& pair) {
  const auto ends = std::make_shared<EndPair>(pair);
  const double start = ends->gap(pair.left.state, pair.right.state);
  if (start < -1e-9 * pair.left.scene.body.length)
    throw SceneError(spec.origin, "the bodies " + std::to_string(pair.index) + " and " +
                                      std::to_string(pair.index + 1) + " overlap by " + to_text(-start) +
                                      " m");
  if (pair.left.wants_end_stress)
    pair.add(Phase::end_stress, "contact: markers in contact carry their own stress",
             [ends](State& left, State& right) {
               const double gap = ends->gap(left, right);
               carry_contact_stress(left, Side::right, gap);
               carry_contact_stress(right, Side::left, gap);
             });
  pair.add(
      Phase::constraint, "contact",
      [ends](State& left, State& right) {
        const double most = approach_limit(left, ends->gap(left, right));
        const double excess = ends->closing_velocity(left, right) - most;
        if (!(excess > 0.0)) return;
        ends->find(left, right);
        left.balance.dissipated -= ends->slow_down(left, right, excess);
      },
      [ends](const State& left, const State& right) {
        return arrival_of(left, ends->gap(left, right), ends->closing_velocity(left, right));
      });
}

}  // namespace

EffectType contact() {
  return {.name = "contact",
          .meaning = "the right end of a body and the left end of the next meet, push, and part again",
          .parameters = {},
          .join = nullptr,
          .conflict = conflict_of_held_end,
          .holds_end = true,
          .own_stress = true,
          .join_pair = join};
}

}  // namespace hompm::detail
