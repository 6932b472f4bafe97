#include <algorithm>
#include <cmath>
#include <cstdint>

#include <hompm/effects/body_end.hpp>
#include <hompm/simulation/held_ends.hpp>
#include <hompm/simulation/simulation.hpp>

namespace hompm::detail {
namespace {

bool holds(const Scene& scene, const EffectSpec& spec) {
  const EffectType& type = find_effect(scene, spec);
  return type.holds_end && !type.couples();
}

/// At rest, with the stress of its own stretch.
void hold_at_rest(const EffectSpec& spec, PlanBuilder& builder) {
  const Side side = side_of(spec);
  if (builder.wants_end_stress) join_own_stress(side, builder);
  builder.add(Phase::constraint, "end at rest", [end = BodyEnd(builder, side)](State& state) mutable {
    end.find(state);
    end.push(state, -end.velocity() / end.compliance());
  });
}

/// `catalogue` must outlive the scene.
Scene trial_of(const Scene& scene, const EffectCatalogue& catalogue) {
  Scene trial = scene;
  trial.kinematics = Kinematics::infinitesimal;
  trial.material.law = "linear";
  trial.bodies.clear();
  trial.initial_velocity.reset();
  trial.initial_displacement.reset();
  trial.effects.clear();
  trial.effect_types = &catalogue;
  for (const EffectSpec& spec : scene.effects) {
    if (!holds(scene, spec)) continue;
    trial.effects.push_back(spec);
    if (find_effect(scene, spec).own_stress) continue;  // it moves, against a force
    trial.effects.back().type = catalogue.back().name;
  }
  return trial;
}

void add_noise(std::vector<double>& velocity) {
  std::uint32_t seed = 7;
  for (double& v : velocity) {
    seed = 1664525u * seed + 1013904223u;
    v = static_cast<double>(seed >> 8) / 8388608.0 - 1.0;
  }
}

}  // namespace

bool has_held_ends(const Scene& scene) {
  return std::ranges::any_of(scene.effects, [&](const EffectSpec& spec) { return holds(scene, spec); });
}

bool stays_bounded(const Scene& scene, double time_step, int steps) {
  constexpr double most_growth = 2.0;  // of the last quarter over the first half; beats do not reach that
  EffectCatalogue catalogue = effects_of(scene);
  catalogue.push_back({.name = "end at rest",
                       .meaning = "an end that is held",
                       .parameters = {},
                       .join = hold_at_rest,
                       .holds_end = true});
  Simulation simulation(trial_of(scene, catalogue), time_step);
  const std::vector<double>& velocity = simulation.state().particles.velocity;
  add_noise(simulation.state().particles.velocity);
  double early = 0.0, late = 0.0;
  for (int step = 1; step <= steps; ++step) {
    simulation.step();
    if (step > steps / 2 && step <= steps / 4 * 3) continue;
    double& largest = step <= steps / 2 ? early : late;
    for (const double v : velocity)
      if (!(std::abs(v) <= largest)) largest = std::abs(v);  // not a number, too
  }
  return late <= most_growth * early;
}

}  // namespace hompm::detail
