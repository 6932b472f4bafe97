#include <cmath>
#include <string>

#include <hompm/effects/body_end.hpp>
#include <hompm/effects/effects.hpp>
#include <hompm/number.hpp>

namespace hompm::detail {
namespace {

/// Two ends that stay together: v_A − v_B = g/δ, so that the gap g, of rounding, is closed anew in every
/// drift.
void join(const EffectSpec& spec, const PairBuilder& pair) {
  const EndPair ends(pair);
  if (const double start = ends.gap(pair.left.state, pair.right.state);
      std::abs(start) > 1e-9 * pair.left.scene.body.length)
    throw SceneError(spec.origin,
                     "the bodies " + std::to_string(pair.index) + " and " + std::to_string(pair.index + 1) +
                         " must touch where they are bonded; between them are " + to_text(start) + " m");
  join_own_stress(Side::right, pair.left);
  join_own_stress(Side::left, pair.right);
  pair.add(ends.coupling("interface", [ends](State& left, State& right) {
    const double apart = left.drift > 0.0 ? ends.gap(left, right) / left.drift : 0.0;
    left.balance.external_work += ends.slow_down(left, right, ends.closing_velocity(left, right) - apart);
  }));
}

}  // namespace

EffectType interface() {
  return {.name = "interface",
          .meaning = "the right end of a body is bonded to the left end of the next",
          .parameters = {},
          .join = nullptr,
          .conflict = conflict_of_held_end,
          .holds_end = true,
          .join_linear = join_coupled_end,
          .join_pair = join};
}

}  // namespace hompm::detail
