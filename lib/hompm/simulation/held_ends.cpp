#include <algorithm>
#include <cmath>
#include <cstdint>

#include <hompm/simulation/held_ends.hpp>
#include <hompm/simulation/linear_step.hpp>

namespace hompm::detail {
namespace {

bool holds(const Scene& scene, const EffectSpec& spec) {
  const EffectType& type = find_effect(scene, spec);
  return type.holds_end && !type.couples();
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
  Simulation simulation = linear_simulation(scene, scene.scheme, LinearEnd::held, time_step);
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
