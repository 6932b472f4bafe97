#include <cmath>
#include <cstdint>

#include <hompm/simulation/critical_step.hpp>
#include <hompm/simulation/simulation.hpp>

namespace hompm {
namespace {

double norm(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

/// A start with a part along every mode: a fixed pseudo-random sequence (Numerical Recipes' linear
/// congruential generator).
std::vector<double> scattered(std::size_t count) {
  std::vector<double> v(count);
  std::uint32_t seed = 1;
  for (double& x : v) {
    seed = 1664525u * seed + 1013904223u;
    x = static_cast<double>(seed >> 8) / 8388608.0 - 1.0;
  }
  return v;
}

}  // namespace

double critical_time_step(const Scene& scene) {
  Scene linear = scene;
  linear.kinematics = Kinematics::infinitesimal;
  linear.material.law = "linear";
  linear.effects.clear();
  linear.initial_velocity.reset();
  Simulation simulation(linear, 1.0);  // the map is linear in Δt: any step will do
  Particles& p = simulation.state().particles;

  std::vector<double> stress = scattered(p.size());
  constexpr int rounds = 400;
  for (int round = 0; round < rounds; ++round) {
    const double length = norm(stress);
    for (double& s : stress) s /= length;
    p.stress = stress;
    for (std::size_t i = 0; i < p.size(); ++i)
      p.stretch[i] = 1.0 + stress[i] / linear.material.youngs_modulus;
    std::fill(p.velocity.begin(), p.velocity.end(), 0.0);
    simulation.step();
    for (std::size_t i = 0; i < p.size(); ++i) stress[i] = p.stress[i] - stress[i];
  }
  return 2.0 / std::sqrt(norm(stress));
}

}  // namespace hompm
