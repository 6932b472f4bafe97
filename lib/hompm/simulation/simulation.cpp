#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include <hompm/effects/registry.hpp>
#include <hompm/scheme/join_scheme.hpp>
#include <hompm/simulation/simulation.hpp>

namespace hompm {
namespace {

constexpr std::array phases_after_geometry{Phase::end_stress,    Phase::internal_force, Phase::external_force,
                                           Phase::damping_force, Phase::acceleration,   Phase::velocity,
                                           Phase::transfer,      Phase::constraint,     Phase::work,
                                           Phase::motion};
constexpr auto force_phases = std::span(phases_after_geometry).first<5>();
constexpr auto projection_phases = std::span(phases_after_geometry).subspan<5, 3>();
constexpr std::array start_phases{Phase::geometry, Phase::end_stress, Phase::internal_force, Phase::velocity};

void check_particle_count(const SchemeSpec& scheme) {
  const SchemeChoices& c = scheme.choices;
  if (c.quadrature == Quadrature::particles && c.stress_update != StressUpdate::from_positions) return;
  const int particles = scheme.cells * scheme.particles_per_cell;
  const bool quintic = c.quadrature == Quadrature::reconstructed_exact && scheme.degree > 3;
  const int fewest = (quintic ? 6 : 2) - (c.markers ? 2 : 0);  // sites of a spline
  if (particles >= fewest) return;
  throw SceneError(Origin{"scheme.particles_per_cell"},
                   std::to_string(particles) + " particle(s) in all: " + scheme.name +
                       " reconstructs fields from at least " + std::to_string(fewest));
}

std::string called_by(const EffectSpec& spec) {
  return "effect " + spec.type + " (" + spec.origin.text() + ")";
}

/// With the line of the scene that names it, if one does.
std::string called_by(const Scene& scene) {
  const auto named = scene.origins.find("scheme.name");
  const std::string where = named == scene.origins.end() ? "by default" : named->second.text();
  return "scheme " + scene.scheme.name + " (" + where + ")";
}

void join_effects(const Scene& scene, PlanBuilder& builder) {
  for (const bool holding : {false, true})
    for (const EffectSpec& spec : scene.effects) {
      const EffectType& type = find_effect(scene, spec);
      if (type.couples() || type.holds_end != holding) continue;
      builder.called_by = called_by(spec);
      type.join(spec, builder);
    }
}

std::vector<Coupling> join_pairs(const Scene& scene, std::vector<PlanBuilder>& builders) {
  std::vector<Coupling> couplings;
  for (const EffectSpec& spec : scene.effects) {
    const EffectType& type = find_effect(scene, spec);
    if (!type.couples()) continue;
    for (std::size_t k = 0; k + 1 < builders.size(); ++k) {
      if (spec.body && static_cast<std::size_t>(*spec.body) != k) continue;
      builders[k].called_by = builders[k + 1].called_by = called_by(spec);
      type.join_pair(spec, {builders[k], builders[k + 1], k, couplings, called_by(spec)});
    }
  }
  return couplings;
}

}  // namespace

std::vector<State> start_states(const Scene& scene) {
  std::vector<State> states;
  for (const Scene* body : bodies_of(scene)) {
    states.push_back(initial_state(*body));
    prepare_effects(*body, states.back());
  }
  return states;
}

Simulation::Simulation(const Scene& scene, double time_step)
    : splitting_(splitting(scene.scheme.choices.time_integrator)), states_(start_states(scene)) {
  std::vector<PlanBuilder> builders;
  for (const Scene* body : bodies_of(scene)) {
    check_particle_count(body->scheme);
    materials_.push_back(make_material(body->material));
    builders.push_back({.scene = *body, .state = states_[builders.size()]});
    builders.back().called_by = called_by(scene);
    join_scheme(materials_.back(), builders.back());
    join_effects(*body, builders.back());
  }
  couplings_ = join_pairs(scene, builders);
  for (PlanBuilder& builder : builders) plans_.push_back(std::move(builder.plan));
  for (State& state : states_) state.time_step = time_step;
  try {
    run(start_phases, states_);
  } catch (const InvalidRun& error) {
    const auto origin = scene.origins.find("scheme.particles_per_cell");
    throw SceneError(origin == scene.origins.end() ? Origin{"scheme.particles_per_cell"} : origin->second,
                     "the scene cannot be started: " + error.reason);
  }
  for (State& state : states_) state.balance = {};
  const HistoryRow start = history(0.0);
  start_energy_ = total_energy(start);
  start_momentum_ = start.momentum;
}

double Simulation::closing_kick() const {
  return splitting_.kicks.size() > splitting_.drifts.size() ? splitting_.kicks.back() : 0.0;
}

void Simulation::run(std::span<const Phase> phases, std::vector<State>& states) const {
  if (states.size() == 1) {  // what a single body does not need costs it nothing
    for (const Phase phase : phases) plans_.front().run(phase, states.front());
    return;
  }
  for (const Phase phase : phases) {
    const Plan* plan = plans_.data();
    for (State& state : states) (plan++)->run(phase, state);
    for (const Coupling& coupling : couplings_)
      if (coupling.phase == phase) coupling.run(states[coupling.left], states[coupling.left + 1]);
  }
}

void Simulation::run_geometry(std::vector<State>& states) const {
  const Plan* plan = plans_.data();
  for (State& state : states) {
    if (state.basis_moves) plan->run(Phase::geometry, state);
    ++plan;
  }
}

void Simulation::step() {
  const std::int64_t step = states_.front().step + 1;
  const double time_step = states_.front().time_step;
  const double start = static_cast<double>(step - 1) * time_step;
  double left_from_last_step = step == 1 ? 0.0 : closing_kick();
  double drifted = 0.0;
  for (std::size_t part = 0; part < splitting_.drifts.size(); ++part) {
    for (State& state : states_) {
      state.step = step;
      state.time = static_cast<double>(step) * time_step;
      state.kick = (left_from_last_step + splitting_.kicks[part]) * time_step;
      state.drift = splitting_.drifts[part] * time_step;
      state.position_time = start + drifted * time_step;
    }
    left_from_last_step = 0.0;
    drifted += splitting_.drifts[part];
    if (step > 1 || part > 0) run_geometry(states_);
    run(phases_after_geometry, states_);
  }
}

std::vector<State> Simulation::synchronised() const {
  std::vector<State> states = states_;
  if (closing_kick() == 0.0 || states.front().step == 0) return states;
  for (State& state : states) {
    state.kick = closing_kick() * state.time_step;
    state.drift = 0.0;
    state.position_time = state.time;
  }
  run_geometry(states);
  run(force_phases, states);
  const bool held =
      std::ranges::any_of(plans_, [](const Plan& plan) { return !plan[Phase::constraint].empty(); });
  if (held || !couplings_.empty()) run(projection_phases, states);
  return states;
}

Snapshot Simulation::snapshot(double time) const {
  const std::vector<State> states = synchronised();
  Snapshot s;
  s.time = time;
  for (std::size_t body = 0; body < states.size(); ++body) {
    const State& state = states[body];
    const Particles& p = state.particles;
    const auto report = [&](const std::vector<double>& field, std::vector<double>& reported) {
      const auto skip = static_cast<std::ptrdiff_t>(p.markers);
      reported.insert(reported.end(), field.begin() + skip, field.end() - skip);
    };
    report(p.reference_position, s.reference_position);
    report(p.displacement, s.displacement);
    report(p.velocity, s.velocity);
    report(p.volume, s.volume);
    std::vector<double> stress = p.stress;
    for (const auto& add : plans_[body].extra_stresses) add(state, stress);
    report(stress, s.stress);
    report(p.stretch, s.stretch);
    for (std::size_t i = p.markers; i < p.size() - p.markers; ++i) {
      s.position.push_back(p.reference_position[i] + p.displacement[i]);
      s.density.push_back(state.density(i));
    }
    if (states.size() > 1) s.body.resize(s.size(), static_cast<std::int64_t>(body));
  }
  return s;
}

double Simulation::next_meeting() const {
  double next = std::numeric_limits<double>::infinity();
  for (std::size_t body = 0; body < bodies(); ++body)
    for (const auto& arrival : plans_[body].arrivals) next = std::min(next, arrival(states_[body]));
  for (const Coupling& coupling : couplings_)
    if (coupling.arrival)
      next = std::min(next, coupling.arrival(states_[coupling.left], states_[coupling.left + 1]));
  return next;
}

double Simulation::total_energy(const HistoryRow& row) const {
  return row.kinetic + row.stored + row.gravity + row.dissipated - row.external_work;
}

HistoryRow Simulation::history(double time) const {
  const std::vector<State> states = synchronised();
  HistoryRow row{.time = time};
  double sum = 0.0;
  double magnitude = 0.0;
  for (std::size_t body = 0; body < states.size(); ++body) {
    const State& state = states[body];
    const Particles& p = state.particles;
    row.dissipated += state.balance.dissipated;
    row.external_work += state.balance.external_work;
    row.impulse += state.balance.impulse;
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
        materials_[body]);
    for (const auto& energy : plans_[body].stored_energies) row.stored += energy(state);
    for (const auto& potential : plans_[body].potentials) row.gravity += potential(state);
    for (const double f : state.fields.internal_force) {
      sum += f;
      magnitude += std::abs(f);
    }
  }
  row.residual = total_energy(row) - start_energy_;
  row.momentum_residual = row.momentum - start_momentum_ - row.impulse;
  row.internal_force_sum = magnitude > 0.0 ? std::abs(sum) / magnitude : 0.0;
  return row;
}

}  // namespace hompm
