#include <array>
#include <cmath>

#include <hompm/effects/registry.hpp>
#include <hompm/scheme/join_scheme.hpp>
#include <hompm/simulation/simulation.hpp>

namespace hompm {
namespace {

constexpr std::array force_phases{Phase::end_stress, Phase::internal_force, Phase::external_force,
                                  Phase::damping_force, Phase::acceleration};
constexpr std::array motion_phases{Phase::velocity, Phase::constraint, Phase::work, Phase::motion};

void check_particle_count(const SchemeSpec& scheme) {
  const SchemeChoices& c = scheme.choices;
  if (c.quadrature == Quadrature::particles && c.stress_update == StressUpdate::incremental) return;
  const int particles = scheme.cells * scheme.particles_per_cell;
  const bool quintic = c.quadrature == Quadrature::reconstructed_exact && scheme.degree > 3;
  const int fewest = (quintic ? 6 : 2) - (c.markers ? 2 : 0);  // sites of a spline
  if (particles >= fewest) return;
  throw SceneError(Origin{"scheme.particles_per_cell"},
                   std::to_string(particles) + " particle(s) in all: " + scheme.name +
                       " reconstructs fields from at least " + std::to_string(fewest));
}

}  // namespace

State start_state(const Scene& scene) {
  State state = initial_state(scene);
  prepare_effects(scene, state);
  return state;
}

Plan make_plan(const Scene& scene, const State& state) {
  check_particle_count(scene.scheme);
  PlanBuilder builder{.scene = scene, .state = state};
  builder.called_by = "scheme " + scene.scheme.name;
  join_scheme(make_material(scene.material), builder);
  for (const bool holding : {false, true})
    for (const EffectSpec& spec : scene.effects) {
      const EffectType& type = find_effect(spec);
      if (type.holds_end != holding) continue;
      builder.called_by = "effect " + spec.type + " (" + spec.origin.text() + ")";
      type.join(spec, builder);
    }
  return builder.plan;
}

Simulation::Simulation(const Scene& scene, double time_step)
    : material_(make_material(scene.material)),
      splitting_(splitting(scene.scheme.choices.time_integrator)),
      state_(start_state(scene)),
      plan_(make_plan(scene, state_)) {
  state_.time_step = time_step;
  try {
    for (const Phase phase : {Phase::geometry, Phase::end_stress, Phase::internal_force, Phase::velocity})
      plan_.run(phase, state_);
  } catch (const InvalidRun& error) {
    const auto origin = scene.origins.find("scheme.particles_per_cell");
    throw SceneError(origin == scene.origins.end() ? Origin{"scheme.particles_per_cell"} : origin->second,
                     "the scene cannot be started: " + error.reason);
  }
  state_.balance = {};
  const HistoryRow start = history(0.0);
  start_energy_ = total_energy(start);
  start_momentum_ = start.momentum;
}

double Simulation::closing_kick() const {
  return splitting_.kicks.size() > splitting_.drifts.size() ? splitting_.kicks.back() : 0.0;
}

void Simulation::step() {
  ++state_.step;
  const double start = static_cast<double>(state_.step - 1) * state_.time_step;
  state_.time = static_cast<double>(state_.step) * state_.time_step;
  double drifted = 0.0;
  for (std::size_t part = 0; part < splitting_.drifts.size(); ++part) {
    const bool start_of_run = state_.step == 1 && part == 0;
    const double left_from_last_step = part == 0 && !start_of_run ? closing_kick() : 0.0;
    state_.kick = (left_from_last_step + splitting_.kicks[part]) * state_.time_step;
    state_.drift = splitting_.drifts[part] * state_.time_step;
    state_.position_time = start + drifted * state_.time_step;
    drifted += splitting_.drifts[part];
    if (state_.moves && !start_of_run) plan_.run(Phase::geometry, state_);
    for (const Phase phase : force_phases) plan_.run(phase, state_);
    for (const Phase phase : motion_phases) plan_.run(phase, state_);
  }
}

State Simulation::synchronised() const {
  State state = state_;
  if (closing_kick() == 0.0 || state.step == 0) return state;
  state.kick = closing_kick() * state.time_step;
  state.drift = 0.0;
  state.position_time = state.time;
  if (state.moves) plan_.run(Phase::geometry, state);
  for (const Phase phase : force_phases) plan_.run(phase, state);
  if (!plan_[Phase::constraint].empty())
    for (const Phase phase : {Phase::velocity, Phase::constraint}) plan_.run(phase, state);
  return state;
}

Snapshot Simulation::snapshot(double time) const {
  const State state = synchronised();
  const Particles& p = state.particles;
  Snapshot s;
  s.time = time;
  const auto reported = [&](const std::vector<double>& field) {
    const auto skip = static_cast<std::ptrdiff_t>(p.markers);
    return std::vector<double>(field.begin() + skip, field.end() - skip);
  };
  s.reference_position = reported(p.reference_position);
  s.displacement = reported(p.displacement);
  s.velocity = reported(p.velocity);
  s.volume = reported(p.volume);
  std::vector<double> stress = p.stress;
  for (const auto& add : plan_.extra_stresses) add(state, stress);
  s.stress = reported(stress);
  s.stretch = reported(p.stretch);
  for (std::size_t i = p.markers; i < p.size() - p.markers; ++i) {
    s.position.push_back(p.reference_position[i] + p.displacement[i]);
    s.density.push_back(state.density(i));
  }
  return s;
}

double Simulation::total_energy(const HistoryRow& row) const {
  return row.kinetic + row.stored + row.gravity + row.dissipated - row.external_work;
}

HistoryRow Simulation::history(double time) const {
  const State state = synchronised();
  const Particles& p = state.particles;
  HistoryRow row{
      .time = time, .dissipated = state.balance.dissipated, .external_work = state.balance.external_work};
  for (std::size_t i = 0; i < p.size(); ++i) {
    row.mass += p.mass[i];
    row.momentum += p.mass[i] * p.velocity[i];
    row.kinetic += 0.5 * p.mass[i] * p.velocity[i] * p.velocity[i];
  }
  std::visit(
      [&](const auto& law) {
        for (std::size_t i = 0; i < p.size(); ++i)
          row.stored += p.reference_volume[i] * law.stored_energy(p.stretch[i]);
      },
      material_);
  for (const auto& energy : plan_.stored_energies) row.stored += energy(state);
  for (const auto& potential : plan_.potentials) row.gravity += potential(state);
  row.impulse = state.balance.impulse;
  row.residual = total_energy(row) - start_energy_;
  row.momentum_residual = row.momentum - start_momentum_ - row.impulse;

  double sum = 0.0;
  double magnitude = 0.0;
  for (const double f : state.fields.internal_force) {
    sum += f;
    magnitude += std::abs(f);
  }
  row.internal_force_sum = magnitude > 0.0 ? std::abs(sum) / magnitude : 0.0;
  return row;
}

}  // namespace hompm
