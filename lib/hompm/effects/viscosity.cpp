#include <hompm/effects/effects.hpp>
#include <hompm/effects/viscous_stress.hpp>

namespace hompm::detail {
namespace {

/// σ + η ∂v/∂x: Kelvin–Voigt with the law linear.
void join(const EffectSpec& spec, const PlanBuilder& builder) {
  join_viscous_stress(
      builder, "viscosity",
      [eta = spec.number("viscosity")](const State&, std::size_t, double rate) { return eta * rate; });
}

SmallMotion small_motion(const EffectSpec& spec, const Scene& scene) {
  return {.viscous_time = spec.number("viscosity") / scene.material.youngs_modulus};
}

}  // namespace

EffectType viscosity() {
  return {.name = "viscosity",
          .meaning = "stress proportional to the strain rate, beside that of the law (Kelvin-Voigt)",
          .parameters = {{.name = "viscosity",
                          .unit = "Pa s",
                          .meaning = "a mode of wave number k decays with viscosity k^2/(2 density)",
                          .minimum = 0.0}},
          .join = join,
          .conflict = needs_forward_kicks,
          .small_motion = small_motion,
          .adds_stress = true};
}

}  // namespace hompm::detail
