#include <cmath>
#include <cstdint>

#include <hompm/scheme/scheme.hpp>
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

/// Trace of one step of length z of the oscillator x'' = −x: stable where it is between −2 and 2.
double trace(const Splitting& splitting, double z) {
  double xx = 1.0, xv = 0.0, vx = 0.0, vv = 1.0;  // the step as a matrix
  for (std::size_t part = 0; part < splitting.kicks.size(); ++part) {
    const double kick = splitting.kicks[part] * z;
    vx -= kick * xx;
    vv -= kick * xv;
    if (part == splitting.drifts.size()) break;
    const double drift = splitting.drifts[part] * z;
    xx += drift * vx;
    xv += drift * vv;
  }
  return xx + vv;
}

/// The z = ω Δt up to which the oscillator x'' = −ω² x is stable: 2 for Euler–Cromer and leapfrog. A
/// fourth-order splitting can have narrow bands of weak growth before its last limit (blanes-moan: 3.1635
/// to 3.1685); the scan is finer than those.
double largest_stable_phase(const Splitting& splitting) {
  constexpr double scan = 1e-3;
  const auto stable = [&](double z) { return std::abs(trace(splitting, z)) <= 2.0 + 1e-9; };
  double low = 0.0;
  while (stable(low + scan)) low += scan;
  double high = low + scan;
  for (int round = 0; round < 40; ++round) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

double critical_time_step(const Scene& scene) {
  Scene linear = scene;
  linear.kinematics = Kinematics::infinitesimal;
  linear.material.law = "linear";
  linear.effects.clear();
  linear.initial_velocity.reset();
  linear.scheme.relaxation_rate = 0.0;
  Simulation simulation(linear, 1.0);
  State& state = simulation.state();
  state.kick = state.drift = 1.0;  // the map is linear in both
  Particles& p = state.particles;
  const auto rest = [&] {
    std::fill(p.displacement.begin(), p.displacement.end(), 0.0);
    std::fill(p.stretch.begin(), p.stretch.end(), 1.0);
    std::fill(p.stress.begin(), p.stress.end(), 0.0);
  };

  std::vector<double> stress = scattered(p.size());
  constexpr int rounds = 400;
  for (int round = 0; round < rounds; ++round) {
    const double length = norm(stress);
    for (double& s : stress) s /= length;
    rest();
    std::fill(p.velocity.begin(), p.velocity.end(), 0.0);
    p.stress = stress;
    for (const Phase phase : {Phase::end_stress, Phase::internal_force, Phase::acceleration})
      simulation.plan().run(phase, state);
    rest();  // so that the motion leaves D A σ alone, whether it adds to the stress or sets it
    for (const Phase phase : {Phase::velocity, Phase::motion}) simulation.plan().run(phase, state);
    stress = p.stress;
  }
  return largest_stable_phase(splitting(scene.scheme.choices.time_integrator)) / std::sqrt(norm(stress));
}

}  // namespace hompm
