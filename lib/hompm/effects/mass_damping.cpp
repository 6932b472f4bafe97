#include <hompm/effects/effects.hpp>
#include <hompm/effects/grid_damping.hpp>

namespace hompm::detail {
namespace {

/// f_i = −β ∫ρ v N_i: b = −β v in the continuum. The row sum M_i v_i instead would be unstable with
/// consistent mass, whose inverse is large for the modes that alternate from cell to cell.
void join(const EffectSpec& spec, const PlanBuilder& builder) {
  if (const auto& grid = builder.discretisation; !grid->keeps_momentum())
    builder.add({.name = "momentum of the grid velocity",
                 .phase = Phase::damping_force,
                 .reads = grid->reads(),
                 .writes = {"grid.momentum"_field},
                 .run = [grid](State& state) { grid->find_momentum(state); }});
  join_grid_damping(
      builder, "mass-proportional damping", {"grid.momentum"_field}, "grid.force"_field,
      [rate = spec.number("rate")](double momentum, double, double) { return -rate * momentum; });
}

}  // namespace

EffectType mass_damping() {
  return {.name = "mass-damping",
          .meaning = "body force against the velocity, b = -rate v",
          .parameters = {{.name = "rate",
                          .unit = "1/s",
                          .meaning = "a mode of small amplitude decays with rate/2",
                          .minimum = 0.0}},
          .join = join,
          .small_motion = [](const EffectSpec& spec, const Scene&) {
            return SmallMotion{.damping_rate = spec.number("rate")};
          }};
}

}  // namespace hompm::detail
