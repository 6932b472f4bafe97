#include <cmath>

#include <hompm/effects/body_end.hpp>
#include <hompm/effects/effects.hpp>
#include <hompm/error.hpp>
#include <hompm/number.hpp>

namespace hompm::detail {
namespace {

/// Two ends that stay together: v_A − v_B = g/δ, so that the gap g, of rounding, is closed anew in every
/// drift.
void join(const EffectSpec& spec, const PairBuilder& pair) {
  BodyEnd a(pair.left, Side::right);
  BodyEnd b(pair.right, Side::left);
  const auto gap = [a, b](const State& left, const State& right) {
    return b.position(right) - a.position(left);
  };
  if (const double start = gap(pair.left.state, pair.right.state);
      std::abs(start) > 1e-9 * pair.left.scene.body.length)
    throw SceneError(spec.origin,
                     "the bodies " + std::to_string(pair.index) + " and " + std::to_string(pair.index + 1) +
                         " must touch where they are bonded; between them are " + to_text(start) + " m");
  if (pair.left.wants_end_stress) {
    join_own_stress(Side::right, pair.left);
    join_own_stress(Side::left, pair.right);
  }
  pair.add(Phase::constraint, "interface", [gap, a, b](State& left, State& right) mutable {
    a.find(left);
    b.find(right);
    const double apart = left.drift > 0.0 ? gap(left, right) / left.drift : 0.0;
    const double impulse = (a.velocity() - b.velocity() - apart) / (a.compliance() + b.compliance());
    a.push(left, -impulse);
    b.push(right, impulse);
    left.balance.external_work += a.work(-impulse) + b.work(impulse);
  });
}

}  // namespace

EffectType interface() {
  return {.name = "interface",
          .meaning = "the right end of a body is bonded to the left end of the next",
          .parameters = {},
          .join = nullptr,
          .conflict = conflict_of_held_end,
          .holds_end = true,
          .join_pair = join};
}

}  // namespace hompm::detail
