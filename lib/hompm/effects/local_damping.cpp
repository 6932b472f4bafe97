#include <cmath>

#include <hompm/effects/effects.hpp>
#include <hompm/effects/grid_damping.hpp>

namespace hompm::detail {
namespace {

/// f_i = −α |f_i| sign(v_i), f_i out of balance (Tielen et al. 2017; Cundall 1987).
void join(const EffectSpec& spec, const PlanBuilder& builder) {
  join_grid_damping(builder, "local damping", {"grid.velocity"_field},
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
