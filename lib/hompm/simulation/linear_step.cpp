#include <algorithm>
#include <cmath>

#include <hompm/simulation/linear_step.hpp>

namespace hompm {
namespace {

Scene linear_scene(const Scene& scene) {
  Scene linear = scene;
  linear.kinematics = Kinematics::infinitesimal;
  linear.material.law = "linear";
  linear.effects.clear();
  linear.bodies.clear();
  linear.initial_velocity.reset();
  linear.scheme.relaxation_rate = 0.0;
  return linear;
}

}  // namespace

LinearStep::LinearStep(const Scene& scene)
    : from_positions_(scene.scheme.choices.stress_update == StressUpdate::from_positions),
      material_(make_material(scene.material)),
      youngs_modulus_(scene.material.youngs_modulus),
      simulation_(linear_scene(scene), 1.0),
      stiffening_(simulation_.state().particles.size(), 1.0) {
  simulation_.state().kick = simulation_.state().drift = 1.0;  // the map is linear in both
}

void LinearStep::linearise(const State& state) { take(state, state.left_boundary, state.right_boundary); }

void LinearStep::linearise_with_cut(const State& state, double cut) {
  const double h = state.grid.cell_width();
  const double origin = state.grid.origin();
  const auto nearest = [&](double x) { return origin + h * std::floor((x - origin) / h + 0.5); };
  const double left = state.left_boundary, right = state.right_boundary;
  const double to_left = state.ends.left == End::free ? nearest(left) - cut * h : left;
  const double to_right = state.ends.right == End::free ? nearest(right) + cut * h : right;
  take(state, to_left, to_right);
}

void LinearStep::take(const State& at, double left, double right) {
  const double stretch = (right - left) / (at.right_boundary - at.left_boundary);
  const double shift = left - stretch * at.left_boundary;
  const double grid_left = at.grid.origin();
  const double grid_right = at.grid.breakpoint(at.grid.cells());
  State& state = simulation_.state();
  Particles& p = state.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    // Where an end stays, rounding must not carry it out of the grid.
    p.position[i] = std::clamp(stretch * at.particles.position[i] + shift, grid_left, grid_right);
    p.volume[i] = stretch * at.particles.volume[i];
    p.mass[i] = stretch * at.particles.mass[i];
    p.reference_density[i] = at.density(i);
  }
  state.left_boundary = left;
  state.right_boundary = right;
  std::visit(
      [&](const auto& law) {
        for (std::size_t i = 0; i < p.size(); ++i) {
          const double lambda = at.particles.stretch[i];
          const double slope =
              from_positions_ ? law.tangent(lambda) : law.modulus(at.particles.stress[i], lambda);
          stiffening_[i] = slope / youngs_modulus_;
        }
      },
      material_);
  simulation_.plan().run(Phase::geometry, state);
}

void LinearStep::apply(const std::vector<double>& stress, std::vector<double>& result) {
  State& state = simulation_.state();
  const Plan& plan = simulation_.plan();
  Particles& p = state.particles;
  std::fill(p.velocity.begin(), p.velocity.end(), 0.0);
  p.stress = stress;
  for (const Phase phase : {Phase::end_stress, Phase::internal_force, Phase::acceleration, Phase::velocity})
    plan.run(phase, state);
  // From rest, so that the motion leaves its own stress alone, whether it adds to the stress or sets it.
  std::fill(p.displacement.begin(), p.displacement.end(), 0.0);
  std::fill(p.stretch.begin(), p.stretch.end(), 1.0);
  std::fill(p.stress.begin(), p.stress.end(), 0.0);
  plan.run(Phase::motion, state);
  for (std::size_t i = 0; i < stiffening_.size(); ++i) result[i] = p.stress[i] * stiffening_[i];
}

}  // namespace hompm
