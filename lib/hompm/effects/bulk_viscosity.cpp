#include <cmath>

#include <hompm/effects/effects.hpp>
#include <hompm/effects/viscous_stress.hpp>

namespace hompm::detail {
namespace {

double wave_speed(const Scene& scene) {
  return std::sqrt(scene.material.youngs_modulus / scene.material.density);
}

double cell_width(const Scene& scene) { return scene.body.length / scene.scheme.cells; }

/// −ρ h |∂v/∂x| (a₂ h |∂v/∂x| + a₁ c) where the material is compressed, nothing elsewhere: a shock becomes
/// some cells wide, whatever its strength (von Neumann, Richtmyer 1950; the linear part: Landshoff 1955).
void join(const EffectSpec& spec, const PlanBuilder& builder) {
  const double h = cell_width(builder.scene);
  const double quadratic = spec.number("quadratic") * h * h;
  const double linear = spec.number("linear") * h * wave_speed(builder.scene);
  join_viscous_stress(
      builder, "bulk viscosity", [quadratic, linear](const State& state, std::size_t p, double rate) {
        // Cells of the reference configuration are stretched with the material.
        const double width = state.moves && !state.basis_moves ? state.particles.stretch[p] : 1.0;
        const double jump = width * rate;
        return rate < 0.0 ? state.density(p) * jump * (linear - quadratic * jump) : 0.0;
      });
}

/// A jump over a cell is at most the speed at the start, and what the strain there becomes, as far as the
/// scene says it.
SmallMotion small_motion(const EffectSpec& spec, const Scene& scene) {
  const double c = wave_speed(scene);
  double jump = scene.initial_velocity ? std::abs(scene.initial_velocity->amplitude) : 0.0;
  if (scene.initial_displacement) jump += c * scene.initial_displacement->steepest(scene.body.length);
  return {.viscous_time =
              (spec.number("linear") + spec.number("quadratic") * jump / c) * cell_width(scene) / c};
}

}  // namespace

EffectType bulk_viscosity() {
  return {.name = "bulk-viscosity",
          .meaning = "artificial viscosity of compression, which spreads shocks over some cells",
          .parameters = {{.name = "quadratic",
                          .unit = "-",
                          .meaning = "coefficient of the square of the velocity jump over a cell",
                          .minimum = 0.0,
                          .default_value = 2.0},
                         {.name = "linear",
                          .unit = "-",
                          .meaning = "coefficient of that jump times the wave speed",
                          .minimum = 0.0,
                          .default_value = 0.5}},
          .join = join,
          .conflict = needs_forward_kicks,
          .small_motion = small_motion,
          .adds_stress = true};
}

}  // namespace hompm::detail
