// What an effect adds in one step, function by function and particle by particle.
#include <cmath>

#include <hompm/simulation/simulation.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

using hompm::Phase;
using hompm::Simulation;
using hompm::test::built_in;

namespace {

/// A column that has one effect, with numbers of its own at every grid function.
Simulation column_with(const hompm::EffectSpec& effect) {
  hompm::Scene scene = built_in("column", "small", {{"scheme.cells", "4"}});
  scene.effects = {effect};
  Simulation simulation(scene, 1e-4);
  auto& g = simulation.state().fields;
  for (std::size_t i = 0; i < g.force.size(); ++i) {
    const double sign = i % 2 == 0 ? 1.0 : -1.0;
    g.momentum[i] = 1.0 + static_cast<double>(i);
    g.force[i] = 2.0 * static_cast<double>(i) - 3.0;
    g.velocity[i] = i == 2 ? 0.0 : sign;
  }
  return simulation;
}

}  // namespace

TEST_CASE("the potential of gravity is that of every particle's own mass and displacement") {
  Simulation simulation = column_with({"gravity", {{"acceleration", -4.0}, {"ramp_time", 0.0}}, {}});
  auto& particles = simulation.state().particles;
  double moment = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.mass[p] = 1.0 + static_cast<double>(p);
    particles.displacement[p] = 0.5 * static_cast<double>(p * p);
    moment += particles.mass[p] * particles.displacement[p];
  }
  CHECK(simulation.history(0.0).gravity == 4.0 * moment);  // all numbers are small multiples of 1/2: exact
}

TEST_CASE("a damping adds its force at its own grid function, and takes that force times velocity") {
  const bool local = GENERATE(true, false);
  Simulation simulation = column_with(local ? hompm::EffectSpec{"local-damping", {{"coefficient", 0.5}}, {}}
                                            : hompm::EffectSpec{"mass-damping", {{"rate", 0.5}}, {}});
  auto& state = simulation.state();
  const auto before = state.fields;
  const double dissipated = state.balance.dissipated;
  state.kick = 2.0;
  state.drift = 4.0;
  const double impulse = state.balance.impulse;
  simulation.plan().run(Phase::damping_force, state);
  double sum = 0.0;
  double power = 0.0;
  for (std::size_t i = 0; i < before.force.size(); ++i) {
    const double v = before.velocity[i];
    const double direction = v == 0.0 ? 0.0 : std::copysign(1.0, v);
    const double force = local ? -0.5 * direction * std::abs(before.force[i]) : -0.5 * before.momentum[i];
    CHECK(state.fields.force[i] == before.force[i] + force);
    sum += force;
    power += force * v;
  }
  CHECK(state.balance.impulse == impulse + 2.0 * sum);
  simulation.plan().run(Phase::work, state);
  CHECK(state.balance.dissipated == dissipated - 4.0 * power);
}

TEST_CASE("viscosity adds to the stress of each particle what its own strain rate makes") {
  Simulation simulation = column_with({"viscosity", {{"viscosity", 2.0}}, {}});
  auto& state = simulation.state();
  const auto before = state.particles.stress;
  simulation.plan().run(Phase::total_stress, state);
  const auto& total = state[simulation.plan().total_stress];
  CHECK(state.particles.stress == before);
  const std::size_t stencil = state.basis.gradients.size() / state.particles.size();
  for (std::size_t p = 0; p < state.particles.size(); ++p) {
    double rate = 0.0;
    for (std::size_t k = 0; k < stencil; ++k)
      rate += state.basis.gradients[p * stencil + k] *
              state.fields.velocity[static_cast<std::size_t>(state.basis.first[p]) + k];
    CHECK(std::abs(total[p] - before[p] - 2.0 * rate) < 1e-14);  // rounding of numbers below 1
  }
}

TEST_CASE("the manufactured solution starts with the velocity of its sine") {
  hompm::Scene scene = built_in("bar", "small", {{"scheme.cells", "4"}});
  scene.initial_velocity.reset();
  scene.effects = {{"manufactured", {{"amplitude", 0.5}}, {}}};
  const auto start = Simulation(scene, 1e-4).snapshot(0.0);
  const double pi = std::acos(-1.0);
  for (std::size_t p = 0; p < start.size(); ++p) {
    const double exact = 0.5 * pi * 10.0 / 25.0 * std::sin(pi * start.reference_position[p] / 25.0);
    CHECK(std::abs(start.velocity[p] - exact) < 1e-14);  // rounding of numbers below 1
  }
}

TEST_CASE("the manufactured force is what its solution needs, in a body of any length") {
  hompm::Scene scene = built_in("bar", "large", {{"scheme.cells", "4"}});
  scene.initial_velocity.reset();
  const double G = 0.5, k = std::acos(-1.0) / 25.0, omega = 10.0 * k, time = 1.25;
  scene.effects = {{"manufactured", {{"amplitude", G}}, {}}};
  Simulation simulation(scene, 1e-4);
  auto& state = simulation.state();
  const auto before = state.particles.velocity;
  state.position_time = time;
  state.kick = 1.0;
  simulation.plan().run(Phase::acceleration, state);
  for (std::size_t p = 0; p < before.size(); ++p) {
    const double X = state.particles.reference_position[p];
    const double swing = G * std::sin(omega * time);
    const double stretch = 1.0 + swing * k * std::cos(k * X);
    // ρ b = ρ ü − ∂σ/∂X with σ = E (1 − 1/λ), c² = 100
    const double b = swing * std::sin(k * X) * (100.0 * k * k / (stretch * stretch) - omega * omega);
    CHECK(std::abs(state.particles.velocity[p] - before[p] - b) < 1e-14);  // rounding of numbers below 1
  }
}
