#include <cmath>

#include <hompm/effects/body_end.hpp>
#include <hompm/effects/effects.hpp>
#include <hompm/materials/material.hpp>

namespace hompm::detail {
namespace {

/// A force −Z v at the end, v the mean of the velocities before and after: J = −κ Z (v⁻ + v⁺)/2, which only
/// takes energy (Lysmer, Kuhlemeyer 1969). Z is the Lagrangian impedance √(ρ0 dσ/dλ), between that of the
/// undeformed material and that at the end the geometric mean: for the law `rate`, ρ0 c/√λ, which an outgoing
/// simple wave has up to third order in its amplitude.
void join(const EffectSpec& spec, PlanBuilder& builder) {
  const Side side = side_of(spec);
  if (builder.wants_end_stress) join_own_stress(side, builder);
  const double density = builder.scene.material.density;
  std::visit(
      [&](const auto& law) {
        builder.add(
            Phase::constraint, "absorbing end",
            [law, side, density, end = BodyEnd(builder, side)](State& state) mutable {
              end.find(state);
              const auto& stretch = state.particles.stretch;
              const double tangent = law.tangent(side == Side::right ? stretch.back() : stretch.front());
              const double impedance = std::sqrt(density * std::sqrt(law.tangent(1.0) * tangent));
              const double half = 0.5 * state.kick * impedance;
              const double impulse =
                  -half * (end.velocity_before() + end.velocity()) / (1.0 + half * end.compliance());
              end.push(state, impulse);
              state.balance.dissipated -= end.work(impulse);
            },
            BodyEnd::arrays);
      },
      make_material(builder.scene.material));
}

}  // namespace

EffectType absorbing() {
  return {.name = "absorbing",
          .meaning = "free end that lets waves out, by the impedance of the material",
          .parameters = {which_end("right")},
          .join = join,
          .conflict = conflict_of_held_end,
          .holds_end = true,
          .own_stress = true};
}

}  // namespace hompm::detail
