#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <variant>

#include <hompm/number.hpp>
#include <hompm/plan/invalid.hpp>
#include <hompm/plan/taken.hpp>
#include <hompm/simulation/guards.hpp>

namespace hompm::detail {
namespace {

[[noreturn]] void throw_first_fault(const State& state) {
  const Particles& p = state.particles;
  for (std::size_t i = 0;; ++i) {
    if (!std::isfinite(p.velocity[i])) throw_not_finite(state, i, "velocity");
    if (!std::isfinite(p.stress[i])) throw_not_finite(state, i, "stress");
    if (!std::isfinite(p.position[i])) throw_not_finite(state, i, "position");
    if (i > 0 && p.position[i] < p.position[i - 1]) throw_out_of_order(state, i);
  }
}

/// Throws where a particle is not as it must be. Returns the kinetic energy, which the same pass has.
double check_particles(const State& state) {
  const Particles& p = state.particles;
  const std::size_t count = p.size();
  const double* mass = p.mass.data();
  const double* velocity = p.velocity.data();
  const double* stress = p.stress.data();
  const double* x = p.position.data();
  double twice = 0.0;
  double zeros = 0.0;  // not a number as soon as one stress or velocity is not finite
  bool ordered = std::isfinite(x[0]) && std::isfinite(x[count - 1]);  // and so what lies between them
  double before = x[0];
  for (std::size_t i = 0; i < count; ++i) {
    twice += mass[i] * velocity[i] * velocity[i];
    zeros += 0.0 * stress[i] + 0.0 * velocity[i];
    ordered &= before <= x[i];
    before = x[i];
  }
  if (zeros != 0.0 || !ordered) throw_first_fault(state);
  return 0.5 * twice;
}

}  // namespace

void Guards::look(const Simulation& simulation) {
  constexpr std::int64_t between_looks = 128;
  if (simulation.state().step % between_looks != 0) return;
  HistoryRow row;
  for (std::size_t body = 0; body < simulation.bodies(); ++body) {
    const State& state = simulation.state(body);
    row.kinetic += check_particles(state);
    row.external_work += state.balance.external_work;
    row.dissipated += state.balance.dissipated;
    for (const auto& potential : simulation.plan(body).potentials) row.gravity += potential(state);
  }
  compare(simulation, row.kinetic, row);
}

void Guards::check(const Simulation& simulation, const HistoryRow& row) {
  for (const State& state : simulation.states()) check_particles(state);
  compare(simulation, row.kinetic + row.stored, row);
}

void Guards::compare(const Simulation& simulation, double energy, const HistoryRow& row) {
  const State& state = simulation.state();
  supplied_ = std::max({supplied_, std::abs(row.gravity), std::abs(row.external_work)});
  // What a load does in its first steps is booked with a velocity that it has yet to make.
  constexpr std::int64_t first_steps = 4;
  constexpr double most = 10.0;
  if (state.step < first_steps) return;
  const double there = start_ + supplied_;
  const auto of_what = [&] {
    return " J/m^2, the start and the loads supplied " +
           (std::isfinite(there) ? to_text(there) : std::string("a number that is not finite")) + "; ";
  };
  const double bound = std::max(there, scale_);
  if (!std::isfinite(energy) || energy > most * bound)
    throw InvalidRun(
        state.step, state.time, -1,
        "unstable: energy " + (std::isfinite(energy) ? to_text(energy) : std::string("not finite")) +
            of_what() +
            "a step that is too large for the motion, or too few particles per cell, are the usual causes");
  if (const LeastTaken least = least_taken(simulation); least.energy < -bound)
    throw InvalidRun(state.step, state.time, -1,
                     "what can only take energy (walls, contact, dampings, viscosities, plasticity) gave " +
                         to_text(-least.energy) + of_what() +
                         (least.by.empty() ? "" : std::string(least.by) + "; ") +
                         "take a smaller time step, or more particles per cell");
}

LeastTaken least_taken(const Simulation& simulation) {
  LeastTaken least;
  for (const State& state : simulation.states()) least.energy += state.balance.dissipated;
  for (const State& state : simulation.states())
    for (const DeclaredField& field : state.declared)
      if (field.name.starts_with("body." + std::string(taken_by_effect)) &&
          field.values.front() < least.energy)
        least = {field.values.front(), field.meaning};
  return least;
}

double energy_scale(const Scene& scene, const std::vector<State>& states) {
  double scale = 0.0;
  const State* state = states.data();
  for (const Scene* body : bodies_of(scene)) {
    // A position is rounded by half its last digit, a strain by that over the distance of two particles.
    const auto& x = state->particles.position;
    const double reach = std::max(std::abs(x.front()), std::abs(x.back())) + body->body.length;
    const double distance = body->body.length / static_cast<double>(x.size());
    const double strain = 64.0 * std::numeric_limits<double>::epsilon() * reach / distance;
    scale += outlook(*body).energy + body->material.youngs_modulus * body->body.length * strain * strain;
    ++state;
  }
  return scale;
}

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
