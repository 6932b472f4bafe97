// A step of `bspline` with p = 2 as a loop by hand over the kernels of the library: no plan, no stages, no
// effects. What the plan costs is the difference.
//
//   hand_step check CELLS STEPS       exit code 1 unless both give the same bits
//   hand_step plan|hand CELLS STEPS   the steps of one alone, for counting instructions
#include <algorithm>
#include <cstring>
#include <string>

#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/scheme/motion.hpp>
#include <hompm/scheme/particle_transfer.hpp>
#include <hompm/scheme/velocity.hpp>
#include <hompm/simulation/simulation.hpp>

namespace {

using hompm::GridFields;
using hompm::Particles;
using hompm::State;
namespace kernels = hompm::detail;

constexpr double time_step = 1e-5;
constexpr int degree = 2;

[[gnu::noinline]] void sum_mass(State& state) {
  std::fill(state.fields.mass.begin(), state.fields.mass.end(), 0.0);
  kernels::scatter<degree>(state, state.basis.values, state.fields.mass,
                           [mass = state.particles.mass.data()](std::size_t p) { return mass[p]; });
}

[[gnu::noinline]] void sum_internal_force(State& state) {
  auto& force = state.fields.internal_force;
  std::fill(force.begin(), force.end(), 0.0);
  kernels::scatter<degree>(state, state.basis.gradients, force,
                           [volume = state.particles.volume.data(), stress = state.particles.stress.data()](
                               std::size_t p) { return volume[p] * stress[p]; });
  GridFields& g = state.fields;
  for (std::size_t i = 0; i < g.force.size(); ++i) g.force[i] = -g.internal_force[i];
}

[[gnu::noinline]] void kick_particles(State& state) {
  const std::size_t count = state.particles.size();
  double* velocity = state.particles.velocity.data();
  const double kick = state.kick;
  const kernels::Gather<degree> acceleration(state, state.basis.values, state.fields.acceleration);
  for (std::size_t p = 0; p < count; ++p) velocity[p] += kick * acceleration(p);
}

[[gnu::noinline]] void move(State& state, const hompm::Rate& law) {
  kernels::move_by_increments<degree, kernels::Motion::updated>(state, law);
}

void step_by_hand(State& state, const hompm::Rate& law) {
  ++state.step;
  state.kick = state.drift = time_step;
  if (state.step > 1) {
    kernels::evaluate_basis<degree>(state);
    sum_mass(state);
  }
  sum_internal_force(state);
  kernels::accelerate_lumped(state);
  kick_particles(state);
  kernels::project_lumped<degree>(state);
  move(state, law);
}

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const std::string mode = argv[1];
  const hompm::Scene scene = hompm::load_builtin(
      "bar", "small", {{"scheme.name", "bspline", "scheme"}, {"scheme.cells", argv[2], "cells"}});
  const int steps = std::stoi(argv[3]);
  hompm::Simulation plan(scene, time_step);
  State hand = plan.state();
  const hompm::Rate law{scene.material.youngs_modulus};
  if (mode != "hand")
    for (int i = 0; i < steps; ++i) plan.step();
  if (mode != "plan")
    for (int i = 0; i < steps; ++i) step_by_hand(hand, law);
  if (mode != "check") return 0;
  const Particles& a = hand.particles;
  const Particles& b = plan.state().particles;
  return same(a.velocity, b.velocity) && same(a.displacement, b.displacement) && same(a.stress, b.stress) ? 0
                                                                                                          : 1;
}
