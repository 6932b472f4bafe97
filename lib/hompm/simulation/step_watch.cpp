#include <algorithm>
#include <cmath>

#include <hompm/simulation/step_watch.hpp>

namespace hompm::detail {

StepWatch::StepWatch(const Scene& scene)
    : moves_(scene.kinematics == Kinematics::finite), bodies_(bodies_of(scene)) {
  for (const Scene* body : bodies_) materials_.push_back(make_material(body->material));
}

double StepWatch::fastest_wave(const std::vector<State>& states) const {
  double largest = 0.0;
  for (std::size_t body = 0; body < states.size(); ++body) {
    const State& state = states[body];
    const Particles& p = state.particles;
    std::visit(
        [&](const auto& law) {
          for (std::size_t i = 0; i < p.size(); ++i) {
            const double modulus =
                state.basis_moves ? law.modulus(p.stress[i], p.stretch[i]) : law.tangent(p.stretch[i]);
            largest = std::max(largest, modulus / state.basis_density(i));
          }
        },
        materials_[body]);
  }
  return std::sqrt(largest);
}

void StepWatch::look(const std::vector<State>& states, RunExtremes& extremes) {
  if (!moves_) return;
  constexpr std::int64_t between_looks = 64;
  constexpr std::int64_t between_checks = 8192;  // some dozen rounds, each the cost of a few steps
  constexpr double rise = 1.02;                  // of the wave speed, by which the critical step falls
  const std::int64_t step = states.front().step;
  if (step % between_looks != 0) return;
  const double fastest = fastest_wave(states);
  const bool faster = fastest > rise * extremes.largest_wave_speed;
  if (!faster && step % between_checks != 0) return;
  extremes.largest_wave_speed = std::max(extremes.largest_wave_speed, fastest);
  if (critical_.empty())
    for (const Scene* body : bodies_) critical_.emplace_back(*body);
  try {
    for (std::size_t body = 0; body < states.size(); ++body)
      extremes.largest_step_fraction =
          std::max(extremes.largest_step_fraction, states[body].time_step / critical_[body].at(states[body]));
  } catch (const InvalidRun&) {
    // What cannot be, the step that comes next says of itself. Where no step is stable the particles may
    // pass; the guards see what grows.
  }  // LCOV_EXCL_LINE: no test has a run that ends at a check
}

}  // namespace hompm::detail
