#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <variant>

#include <hompm/scheme/join_scheme.hpp>
#include <hompm/simulation/linear_step.hpp>

namespace hompm {
namespace {

/// The scheme without what has no part in the linear step: relaxation, and the order of update stress first.
SchemeSpec without_relaxation(SchemeSpec scheme) {
  scheme.relaxation_rate = 0.0;
  if (scheme.choices.sequence == Sequence::usf) scheme.choices.sequence = Sequence::musl;
  return scheme;
}

/// What a unit of the gradient of the displacement, over the configuration that the basis lives on, adds to
/// the stress (Pa).
template <class Law>
double stiffness(const Law& law, const SchemeChoices& choices, double stress, double stretch) {
  if (choices.stress_update == StressUpdate::from_positions) return law.tangent(stretch);
  const double per_strain = choices.stress_update == StressUpdate::incremental
                                ? law.modulus(stress, stretch)
                                : stretch * law.tangent(stretch);
  return choices.formulation == Formulation::total_lagrangian ? per_strain / stretch : per_strain;
}

/// The least factor by which a transfer multiplies the velocity of a mode in a step. Projections by least
/// squares leave alone what the grid sees.
double least_kept(const SchemeChoices& choices) {
  if (choices.velocity_projection == VelocityProjection::least_squares) return 1.0;
  return choices.transfer == Transfer::flip ? choices.flip_fraction : 0.0;
}

/// With USL all that a particle keeps may be what the grid velocity says.
bool keeps_what_the_grid_says(const SchemeChoices& choices) {
  return choices.sequence == Sequence::usl &&
         (choices.transfer == Transfer::pic || choices.transfer == Transfer::apic) &&
         choices.velocity_projection == VelocityProjection::lumped;
}

/// 1/(1 + r) in powers of r, to 3e-4 for 0 ≤ r ≤ 1: through the five Chebyshev points.
constexpr std::array inverse_of_one_and{0.9997, -0.98483, 0.86589, -0.53286, 0.15225};

}  // namespace

Simulation linear_simulation(const Scene& scene, const SchemeSpec& scheme, LinearEnd ends, double time_step) {
  State state = undeformed_state(scene);
  Plan plan;
  const StageBuilder builder{scene, scheme, state, plan, "the critical time step"};
  const auto grid = join_scheme(Linear{scene.material.youngs_modulus}, builder);
  join_linear_ends(scene, ends, {builder, grid});
  return {scene, time_step, std::move(state), std::move(plan)};
}

LinearStep::LinearStep(const Scene& scene)
    : choices_(scene.scheme.choices),
      material_(make_material(scene.material)),
      youngs_modulus_(scene.material.youngs_modulus),
      simulation_(linear_simulation(scene, without_relaxation(scene.scheme), LinearEnd::let_go, 1.0)),
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
  const double most_left = at.ends.left == End::fixed ? left : at.grid.origin();
  const double most_right = at.ends.right == End::fixed ? right : at.grid.breakpoint(at.grid.cells());
  State& state = simulation_.state();
  Particles& p = state.particles;
  const auto& positions = at.basis_moves ? at.particles.position : at.particles.reference_position;
  const auto& volumes = at.basis_volumes();
  // Where an end stays, rounding must not carry it out of the grid.
  const auto moved = [&](double x) { return std::clamp(stretch * x + shift, most_left, most_right); };
  for (std::size_t i = 0; i < p.size(); ++i) {
    p.position[i] = moved(positions[i]);
    p.volume[i] = stretch * volumes[i];
    p.mass[i] = stretch * at.particles.mass[i];
    p.reference_density[i] = at.basis_density(i);
  }
  if (auto* ends = state.find("particles.right_end"))
    std::ranges::transform(*at.find("particles.right_end"), ends->begin(), moved);
  state.left_boundary = left;
  state.right_boundary = right;
  std::visit(
      [&](const auto& law) {
        for (std::size_t i = 0; i < p.size(); ++i) {
          const Particles& now = at.particles;
          stiffening_[i] = stiffness(law, choices_, now.stress[i], now.stretch[i]) / youngs_modulus_;
        }
      },
      material_);
  simulation_.plan().run(Phase::geometry, state);
}

void LinearStep::apply(const std::vector<double>& stress, std::vector<double>& result) {
  State& state = simulation_.state();
  Particles& p = state.particles;
  std::fill(p.velocity.begin(), p.velocity.end(), 0.0);
  p.stress = stress;
  run_step();
  for (std::size_t i = 0; i < stiffening_.size(); ++i) result[i] = p.stress[i] * stiffening_[i];
  if (keeps_what_the_grid_says(choices_)) return add_returns(result);

  const double kept = least_kept(choices_);
  const bool last = choices_.sequence == Sequence::usl;
  const double direct = last ? 2.0 : 2.0 / (1.0 + kept);
  for (double& r : result) r *= direct;
  if (!last || kept == 0.0) return;
  std::fill(p.stress.begin(), p.stress.end(), 0.0);
  run_step();
  const double through_particles = 2.0 * kept / (1.0 + kept);
  for (std::size_t i = 0; i < stiffening_.size(); ++i)
    result[i] -= through_particles * (p.stress[i] * stiffening_[i]);
}

void LinearStep::add_returns(std::vector<double>& result) {
  State& state = simulation_.state();
  const Plan& plan = simulation_.plan();
  for (double& r : result) r *= 2.0 * inverse_of_one_and.front();
  std::fill(state.fields.acceleration.begin(), state.fields.acceleration.end(), 0.0);
  for (std::size_t k = 1; k < inverse_of_one_and.size(); ++k) {
    plan.run(Phase::transfer, state);
    plan.run(Phase::velocity, state);
    strain();
    for (std::size_t i = 0; i < stiffening_.size(); ++i)
      result[i] += 2.0 * inverse_of_one_and[k] * state.particles.stress[i] * stiffening_[i];
  }
}

void LinearStep::run_step() {
  State& state = simulation_.state();
  if (auto* gradient = state.find("particles.velocity_gradient")) std::ranges::fill(*gradient, 0.0);
  for (const Phase phase :
       {Phase::total_stress, Phase::end_stress, Phase::internal_force, Phase::acceleration, Phase::velocity})
    simulation_.plan().run(phase, state);
  strain();
}

void LinearStep::strain() {
  State& state = simulation_.state();
  Particles& p = state.particles;
  // From rest, so that the motion leaves its own stress alone, whether it adds to the stress or sets it.
  std::fill(p.displacement.begin(), p.displacement.end(), 0.0);
  std::fill(p.stretch.begin(), p.stretch.end(), 1.0);
  std::fill(p.stress.begin(), p.stress.end(), 0.0);
  simulation_.plan().run(Phase::motion, state);
}

}  // namespace hompm

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
