#include <algorithm>
#include <array>
#include <cmath>

#include <hompm/effects/registry.hpp>
#include <hompm/scheme/join_scheme.hpp>
#include <hompm/simulation/simulation.hpp>

namespace hompm {
namespace {

constexpr std::array step_phases{Phase::internal_force, Phase::external_force, Phase::damping_force,
                                 Phase::acceleration,   Phase::velocity,       Phase::work,
                                 Phase::motion};

void check_particle_count(const Scene& scene, const Scheme& scheme) {
  if (scheme.quadrature == Quadrature::particles || scene.scheme.cells * scene.scheme.particles_per_cell >= 2)
    return;
  throw SceneError(Origin{"scheme.particles_per_cell"},
                   "1 particle in all: " + scheme.name + " reconstructs fields from at least 2");
}

}  // namespace

Plan make_plan(const Scene& scene, const State& state) {
  const Scheme& scheme = find_scheme(scene.scheme.name);
  check_particle_count(scene, scheme);
  PlanBuilder builder{.scene = scene, .state = state};
  builder.called_by = "scheme " + scheme.name;
  join_scheme(scheme, make_material(scene.material), builder);
  for (const EffectSpec& spec : scene.effects) {
    const auto& catalogue = effect_catalogue();
    const auto type =
        std::find_if(catalogue.begin(), catalogue.end(), [&](const auto& t) { return t.name == spec.type; });
    if (type == catalogue.end()) throw SceneError(spec.origin, "there is no effect " + spec.type);
    builder.called_by = "effect " + spec.type + " (" + spec.origin.text() + ")";
    type->join(spec, builder);
  }
  return builder.plan;
}

Simulation::Simulation(const Scene& scene, double time_step)
    : material_(make_material(scene.material)),
      moves_(scene.kinematics == Kinematics::finite),
      state_(initial_state(scene)),
      plan_(make_plan(scene, state_)) {
  state_.time_step = time_step;
  plan_.run(Phase::geometry, state_);
  plan_.run(Phase::internal_force, state_);
  plan_.run(Phase::velocity, state_);
  const HistoryRow start = history(0.0);
  start_energy_ = total_energy(start);
  start_momentum_ = start.momentum;
}

void Simulation::step() {
  ++state_.step;
  state_.time = static_cast<double>(state_.step) * state_.time_step;
  if (moves_ && state_.step > 1) plan_.run(Phase::geometry, state_);
  for (const Phase phase : step_phases) plan_.run(phase, state_);
}

Snapshot Simulation::snapshot(double time) const {
  const Particles& p = state_.particles;
  Snapshot s{.time = time,
             .reference_position = p.reference_position,
             .position = p.position,
             .displacement = p.displacement,
             .velocity = p.velocity,
             .volume = p.volume,
             .density = p.mass,
             .stress = p.stress,
             .stretch = p.stretch};
  for (std::size_t i = 0; i < s.size(); ++i) {
    s.density[i] = p.mass[i] / p.volume[i];
    s.position[i] = p.reference_position[i] + p.displacement[i];
  }
  return s;
}

double Simulation::total_energy(const HistoryRow& row) const {
  return row.kinetic + row.stored + row.gravity + row.dissipated - row.external_work;
}

HistoryRow Simulation::history(double time) const {
  const Particles& p = state_.particles;
  HistoryRow row{
      .time = time, .dissipated = state_.balance.dissipated, .external_work = state_.balance.external_work};
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
  for (const auto& potential : plan_.potentials) row.gravity += potential(state_);
  row.impulse = state_.balance.impulse;
  row.residual = total_energy(row) - start_energy_;
  row.momentum_residual = row.momentum - start_momentum_ - row.impulse;

  double sum = 0.0;
  double magnitude = 0.0;
  for (const double f : state_.fields.internal_force) {
    sum += f;
    magnitude += std::abs(f);
  }
  row.internal_force_sum = magnitude > 0.0 ? std::abs(sum) / magnitude : 0.0;
  return row;
}

}  // namespace hompm
