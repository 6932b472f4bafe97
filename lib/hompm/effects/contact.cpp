#include <limits>

#include <hompm/effects/body_end.hpp>
#include <hompm/effects/effects.hpp>
#include <hompm/error.hpp>
#include <hompm/number.hpp>

namespace hompm::detail {
namespace {

/// Two ends that may close the gap g between them within the drift, and no more: v_A − v_B ≤ g/δ, by an
/// impulse that pushes them apart (as wall.cpp, with the compliance of both).
void join(const EffectSpec& spec, const PairBuilder& pair) {
  BodyEnd a(pair.left, Side::right);
  BodyEnd b(pair.right, Side::left);
  const double start = b.position(pair.right.state) - a.position(pair.left.state);
  if (start < -1e-9 * pair.left.scene.body.length)
    throw SceneError(spec.origin, "the bodies " + std::to_string(pair.index) + " and " +
                                      std::to_string(pair.index + 1) + " overlap by " + to_text(-start) +
                                      " m");
  const auto gap = [a, b](const State& left, const State& right) {
    return b.position(right) - a.position(left);
  };
  if (pair.left.wants_end_stress)
    pair.add(Phase::end_stress, "contact: markers in contact carry their own stress",
             [gap](State& left, State& right) {
               carry_contact_stress(left, Side::right, gap(left, right));
               carry_contact_stress(right, Side::left, gap(left, right));
             });
  pair.add(Phase::constraint, "contact", [gap, a, b](State& left, State& right) mutable {
    const double most = approach_limit(left, gap(left, right));
    if (most == std::numeric_limits<double>::infinity()) return;
    a.find(left);
    b.find(right);
    const double excess = a.velocity() - b.velocity() - most;
    if (!(excess > 0.0)) return;
    const double impulse = excess / (a.compliance() + b.compliance());
    a.push(left, -impulse);
    b.push(right, impulse);
    left.balance.dissipated -= a.work(-impulse) + b.work(impulse);
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
          .join_pair = join};
}

}  // namespace hompm::detail
