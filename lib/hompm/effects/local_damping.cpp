#include <cmath>
#include <utility>

#include <hompm/effects/effects.hpp>
#include <hompm/effects/grid_damping.hpp>

namespace hompm::detail {
namespace {

/// f_i = −α |f_i| sign(v_i), f_i out of balance (Tielen et al. 2017; Cundall 1987). What acts on a function
/// that is tied is balanced by the forces on those that carry it, and does not vanish at rest.
void join(const EffectSpec& spec, const PlanBuilder& builder) {
  Fields reads{"grid.velocity"_field};
  Field acting = "grid.force"_field;
  if (const auto& discretisation = builder.discretisation; discretisation->ties()) {
    acting = builder.field({"force_out_of_balance", "Pa", "of functions that move", Site::function});
    Stage stage{.name = "out-of-balance force of functions that move",
                .phase = Phase::damping_force,
                .reads = discretisation->reads(),
                .writes = {acting},
                .run = [discretisation, acting](State& state) {
                  state[acting] = state.fields.force;
                  discretisation->untie(state, state[acting]);
                }};
    stage.reads.push_back("grid.force"_field);
    builder.add(std::move(stage));
    reads.push_back(acting);
  }
  join_grid_damping(builder, "local damping", reads, acting,
                    [alpha = spec.number("coefficient")](double, double force, double velocity) {
                      if (velocity == 0.0) return 0.0;
                      return velocity > 0.0 ? -alpha * std::abs(force) : alpha * std::abs(force);
                    });
}

}  // namespace

EffectType local_damping() {
  return {.name = "local-damping",
          .meaning =
              "non-viscous damping: a fraction of the out-of-balance force, against the velocity; for "
              "finding rest",
          .parameters =
              {{.name = "coefficient", .unit = "-", .meaning = "fraction", .minimum = 0.0, .maximum = 0.99}},
          .join = join,
          .small_motion = [](const EffectSpec& spec, const Scene&) {
            return SmallMotion{.force_factor = 1.0 + spec.number("coefficient")};
          }};
}

}  // namespace hompm::detail
