// How each effect of the catalogue joins a plan. One file per effect; the catalogue (registry.cpp) names
// them.
#pragma once

#include <hompm/effects/registry.hpp>
#include <hompm/plan/plan.hpp>

namespace hompm::detail {

EffectType gravity();
EffectType traction();
EffectType mass_damping();
EffectType local_damping();
EffectType viscosity();
EffectType bulk_viscosity();
EffectType manufactured();
EffectType plasticity();
EffectType piston();
EffectType wall();
EffectType absorbing();
EffectType contact();
EffectType interface();

}  // namespace hompm::detail
