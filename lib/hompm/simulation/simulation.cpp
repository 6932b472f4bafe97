#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <hompm/effects/registry.hpp>
#include <hompm/scheme/join_scheme.hpp>
#include <hompm/simulation/simulation.hpp>

namespace hompm {
namespace {

constexpr std::array phases_after_geometry{Phase::strain,         Phase::total_stress,   Phase::end_stress,
                                           Phase::internal_force, Phase::external_force, Phase::damping_force,
                                           Phase::acceleration,   Phase::velocity,       Phase::transfer,
                                           Phase::constraint,     Phase::work,           Phase::motion};
constexpr auto force_phases = std::span(phases_after_geometry).first<7>();
constexpr auto projection_phases = std::span(phases_after_geometry).subspan<7, 3>();
constexpr std::array start_phases{Phase::geometry,   Phase::strain,         Phase::total_stress,
                                  Phase::end_stress, Phase::internal_force, Phase::velocity};

void check_data_sites(const SchemeSpec& scheme) {
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

using Discretisations = std::vector<std::shared_ptr<const Discretisation>>;

/// Those that hold an end last.
void join_effects(const Scene& scene, State& state, Plan& plan,
                  const std::shared_ptr<const Discretisation>& grid) {
  for (const bool holding : {false, true})
    for (const EffectSpec& spec : scene.effects)
      if (const EffectType& type = find_effect(scene, spec); !type.couples() && type.holds_end == holding)
        type.join(spec, {{scene, scene.scheme, state, plan, called_by(spec)}, grid});
}

std::vector<Coupling> join_pairs(const Scene& scene, const Discretisations& grids, std::vector<State>& states,
                                 std::vector<Plan>& plans) {
  const auto bodies = bodies_of(scene);
  std::vector<Coupling> couplings;
  for (const EffectSpec& spec : scene.effects) {
    const EffectType& type = find_effect(scene, spec);
    if (!type.couples()) continue;
    const auto builder = [&](std::size_t k) {
      return PlanBuilder{{*bodies[k], bodies[k]->scheme, states[k], plans[k], called_by(spec)}, grids[k]};
    };
    for (std::size_t k = 0; k + 1 < bodies.size(); ++k) {
      if (spec.body && static_cast<std::size_t>(*spec.body) != k) continue;
      type.join_pair(spec, {builder(k), builder(k + 1), k, couplings});
    }
  }
  return couplings;
}

Plan plan_of_scheme(const Scene& scene, const Material& material, State& state, Discretisations& grids) {
  Plan plan;
  const StageBuilder builder{scene, scene.scheme, state, plan, called_by(scene)};
  if (std::ranges::any_of(scene.effects,
                          [&](const auto& spec) { return find_effect(scene, spec).adds_stress; }))
    builder.add_total_stress();
  grids.push_back(join_scheme(material, builder));
  return plan;
}

}  // namespace

Simulation::Simulation(const Scene& scene, double time_step)
    : splitting_(splitting(scene.scheme.choices.time_integrator)) {
  const auto bodies = bodies_of(scene);
  Discretisations grids;
  for (const Scene* body : bodies) {
    states_.push_back(initial_state(*body));
    prepare_effects(*body, states_.back());
    check_data_sites(body->scheme);
    materials_.push_back(make_material(body->material));
    plans_.push_back(plan_of_scheme(*body, materials_.back(), states_.back(), grids));
  }
  for (std::size_t k = 0; k < bodies.size(); ++k) join_effects(*bodies[k], states_[k], plans_[k], grids[k]);
  couplings_ = join_pairs(scene, grids, states_, plans_);
  start(scene, time_step);
}

Simulation::Simulation(const Scene& scene, double time_step, State state, Plan plan)
    : splitting_(splitting(scene.scheme.choices.time_integrator)), materials_{make_material(scene.material)} {
  states_.push_back(std::move(state));
  plans_.push_back(std::move(plan));
  start(scene, time_step);
}

void Simulation::start(const Scene& scene, double time_step) {
  for (std::size_t k = 0; k < plans_.size(); ++k) check_plan(plans_[k], states_[k], couplings_, k);
  for (State& state : states_) state.time_step = time_step;
  try {
    run(start_phases, states_);
  } catch (const InvalidRun& error) {
    throw SceneError(scene.origin_of("scheme.particles_per_cell"),
                     "the scene cannot be started: " + error.reason);
  }
  for (State& state : states_) state.balance = {};
  const HistoryRow start = history(0.0);
  start_energy_ = total_energy(start);
  start_momentum_ = start.momentum;
}

double Simulation::closing_kick() const {
  const State& state = states_.front();
  const bool closes = splitting_.kicks.size() > splitting_.drifts.size();
  return closes && state.step > 0 ? splitting_.kicks.back() * state.time_step : 0.0;
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

namespace {

/// time + length, with what rounding takes off kept: after n steps of one length, n · length rounded once.
void advance(State& state, double length) {
  const double sum = state.time + length;
  const double part = sum - state.time;
  const double rest = state.time_rest + ((state.time - (sum - part)) + (length - part));
  state.time = sum + rest;
  state.time_rest = rest - (state.time - sum);
}

}  // namespace

void Simulation::step(double length) {
  double left = closing_kick();
  const double start = states_.front().time;
  for (State& state : states_) {
    ++state.step;
    state.time_step = length;
    advance(state, length);
  }
  double drifted = 0.0;
  for (std::size_t part = 0; part < splitting_.drifts.size(); ++part) {
    for (State& state : states_) {
      state.kick = left + splitting_.kicks[part] * length;
      state.drift = splitting_.drifts[part] * length;
      state.position_time = start + drifted * length;
    }
    left = 0.0;
    drifted += splitting_.drifts[part];
    if (states_.front().step > 1 || part > 0) run_geometry(states_);
    run(phases_after_geometry, states_);
  }
}

std::vector<State> Simulation::after_closing_kick() const {
  std::vector<State> states = states_;
  const double kick = closing_kick();
  if (kick == 0.0) return states;
  for (State& state : states) {
    state.kick = kick;
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

namespace {

/// Where a snapshot has the values of the field; 0 for the `before` particles of other bodies.
std::vector<double>& reported_as(const DeclaredField& field, std::size_t before, Snapshot& snapshot) {
  const std::string name = field.name.substr(field.name.find('.') + 1);
  auto found = std::ranges::find(snapshot.reported, name, &ReportedField::name);
  if (found == snapshot.reported.end())
    found = snapshot.reported.insert(found, {name, field.unit, std::vector<double>(before)});
  return found->values;
}

}  // namespace

Snapshot Simulation::snapshot(double time) const {
  std::vector<State> states = after_closing_kick();
  Snapshot s;
  s.time = time;
  for (std::size_t body = 0; body < states.size(); ++body) {
    State& state = states[body];
    plans_[body].run(Phase::total_stress, state);
    const std::size_t before = s.size();
    const Particles& p = state.particles;
    const auto report = [&](const std::vector<double>& field, std::vector<double>& reported) {
      const auto skip = static_cast<std::ptrdiff_t>(p.markers);
      reported.insert(reported.end(), field.begin() + skip, field.end() - skip);
    };
    report(p.reference_position, s.reference_position);
    report(p.displacement, s.displacement);
    report(p.velocity, s.velocity);
    report(p.volume, s.volume);
    report(state[plans_[body].total_stress], s.stress);
    report(p.stretch, s.stretch);
    for (std::size_t i = p.markers; i < p.size() - p.markers; ++i) {
      s.position.push_back(p.reference_position[i] + p.displacement[i]);
      s.density.push_back(state.density(i));
    }
    for (const DeclaredField& field : state.declared)
      if (field.reported) report(field.values, reported_as(field, before, s));
    for (ReportedField& field : s.reported) field.values.resize(s.size());
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
  const std::vector<State> states = after_closing_kick();
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
