#include <cmath>
#include <utility>
#include <variant>

#include <hompm/effects/body_end.hpp>
#include <hompm/effects/effects.hpp>
#include <hompm/materials/material.hpp>

namespace hompm::detail {
namespace {

/// A force −Z v at the end, v the mean of the velocities before and after: J = −κ Z (v⁻ + v⁺)/2, which only
/// takes energy (Lysmer, Kuhlemeyer 1969). Z is the Lagrangian impedance √(ρ0 dσ/dλ), between that of the
/// undeformed material and that at the end the geometric mean: for the law `rate`, ρ0 c/√λ, which an outgoing
/// simple wave has up to third order in its amplitude.
template <class Law>
void join_law(const Law& law, Side side, const PlanBuilder& builder) {
  join_own_stress(side, builder);
  const BodyEnd end(builder, side);
  Stage stage =
      end.stage("absorbing end", [law, side, end, density = builder.scene.material.density](State& state) {
        const auto response = end.find(state);
        const auto& stretch = state.particles.stretch;
        const double tangent = law.tangent(side == Side::right ? stretch.back() : stretch.front());
        const double impedance = std::sqrt(density * std::sqrt(law.tangent(1.0) * tangent));
        const double half = 0.5 * state.kick * impedance;
        const double impulse =
            -half * (response.velocity_before + response.velocity) / (1.0 + half * response.compliance);
        state.balance.dissipated -= end.push(state, response, impulse);
      });
  stage.reads.push_back("particles.stretch"_field);
  builder.add(std::move(stage));
}

void join(const EffectSpec& spec, const PlanBuilder& builder) {
  std::visit([&](const auto& law) { join_law(law, side_of(spec), builder); },
             make_material(builder.scene.material));
}

/// It moves, against a force.
void join_linear(Side side, LinearEnd how, const PlanBuilder& builder) {
  if (how == LinearEnd::let_go) return join_own_stress(side, builder);
  join_law(Linear{builder.scene.material.youngs_modulus}, side, builder);
}

}  // namespace

EffectType absorbing() {
  return {.name = "absorbing",
          .meaning = "free end that lets waves out, by the impedance of the material",
          .parameters = {which_end("right")},
          .join = join,
          .conflict = conflict_of_held_end,
          .holds_end = true,
          .join_linear = join_linear};
}

}  // namespace hompm::detail
