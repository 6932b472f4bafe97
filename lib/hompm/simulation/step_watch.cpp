#include <algorithm>
#include <cmath>

#include <hompm/simulation/critical_step.hpp>
#include <hompm/simulation/step_watch.hpp>

namespace hompm::detail {

namespace {

double fastest_wave(const Material& material, const State& state) {
  const Particles& p = state.particles;
  double largest = 0.0;
  std::visit(
      [&](const auto& law) {
        for (std::size_t i = 0; i < p.size(); ++i)
          largest = std::max(largest, law.modulus(p.stress[i], p.stretch[i]) / state.density(i));
      },
      material);
  return std::sqrt(largest);
}

}  // namespace

double fastest_wave(const Scene& scene, const std::vector<State>& states) {
  double fastest = 0.0;
  std::size_t body = 0;
  for (const Scene* part : bodies_of(scene))
    fastest = std::max(fastest, fastest_wave(make_material(part->material), states[body++]));
  return fastest;
}

void watch_step(const Scene& scene, const std::vector<State>& states, RunExtremes& extremes) {
  if (scene.kinematics == Kinematics::infinitesimal) return;
  constexpr std::int64_t between_looks = 64;
  constexpr std::int64_t between_checks = 2048;  // a dozen rounds, each the cost of a step
  constexpr double rise = 1.02;                  // of the wave speed, by which the critical step falls
  const std::int64_t step = states.front().step;
  if (step % between_looks != 0) return;
  const double fastest = fastest_wave(scene, states);
  const bool faster = fastest > rise * extremes.largest_wave_speed;
  if (!faster && step % between_checks != 0) return;
  extremes.largest_wave_speed = std::max(extremes.largest_wave_speed, fastest);
  try {
    std::size_t body = 0;
    for (const Scene* part : bodies_of(scene)) {
      const State& state = states[body++];
      const double critical = CriticalStep(*part).at(state);
      extremes.largest_step_fraction = std::max(extremes.largest_step_fraction, state.time_step / critical);
    }
  } catch (const InvalidRun&) {
    // The step that comes next says the same of itself.
  }  // LCOV_EXCL_LINE: no test has a run that ends at a check
}

}  // namespace hompm::detail
