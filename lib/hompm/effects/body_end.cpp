#include <algorithm>
#include <limits>
#include <utility>

#include <hompm/effects/body_end.hpp>

namespace hompm::detail {

Side side_of(const EffectSpec& spec) { return spec.text("end") == "right" ? Side::right : Side::left; }

EffectParameter which_end(const std::string& standard) {
  return {.name = "end",
          .unit = "",
          .meaning = "which end",
          .words = {"left", "right"},
          .default_value = standard};
}

std::string conflict_of_held_end(const EffectSpec&, const Scene& scene) {
  if (scene.scheme.choices.transfer == Transfer::apic)
    return "its impulse changes the velocity of particles, not its gradient: `scheme.transfer` must not be "
           "\"apic\", `scheme.sequence` must be \"musl\"";
  if (scene.scheme.choices.sequence != Sequence::musl)
    return "its impulse goes to the grid through the particles: `scheme.sequence` must be \"musl\"";
  if (scene.scheme.choices.time_integrator != TimeIntegrator::blanes_moan) return "";
  return "it takes a `scheme.time_integrator` whose kicks all go forward in time: \"euler-cromer\" or "
         "\"leapfrog\", not "
         "\"blanes-moan\"";
}

void join_own_stress(Side side, const StageBuilder& builder) {
  if (!builder.has_markers()) return;
  const bool right = side == Side::right;
  builder.add({.name = "held end: its marker carries its own stress",
               .phase = Phase::end_stress,
               .reads = {builder.plan.total_stress},
               .changes = {right ? "right_stress"_field : "left_stress"_field},
               .run = [right, total = builder.plan.total_stress](State& state) {
                 const auto& stress = state[total];
                 (right ? state.right_stress : state.left_stress) = right ? stress.back() : stress.front();
               }});
}

void join_standing_end(Side side, LinearEnd how, const PlanBuilder& builder) {
  if (how == LinearEnd::let_go) return;
  join_own_stress(side, builder);
  const BodyEnd end(builder, side);
  builder.add(end.stage("end at rest", [end](State& state) {
    const auto response = end.find(state);
    end.push(state, response, -response.velocity / response.compliance);
  }));
}

void join_coupled_end(Side side, LinearEnd /*how*/, const PlanBuilder& builder) {
  join_own_stress(side, builder);
}

namespace {
/// Shut is a gap of less than this part of a cell: far above rounding and what relaxation moves in a step,
/// far below what the grid resolves.
bool is_shut(const State& state, double gap) { return gap <= 1e-3 * state.grid.cell_width(); }
}  // namespace

void carry_contact_stress(State& state, Field total_stress, Side side, double gap) {
  if (!is_shut(state, gap)) return;
  const bool right = side == Side::right;
  const double own = right ? state[total_stress].back() : state[total_stress].front();
  (right ? state.right_stress : state.left_stress) += std::min(own, 0.0);
}

double approach_limit(const State& state, double gap) {
  if (state.drift > 0.0) return gap / state.drift;
  return is_shut(state, gap) ? 0.0 : std::numeric_limits<double>::infinity();
}

double arrival_of(const State& state, double gap, double closing_velocity) {
  const bool closes = closing_velocity > 0.0 && !is_shut(state, gap);
  return closes ? gap / closing_velocity : std::numeric_limits<double>::infinity();
}

BodyEnd::BodyEnd(const PlanBuilder& builder, Side side)
    : discretisation_(builder.discretisation),
      grid_response_(
          builder.field({"end_response", "m/kg", "grid velocity of a unit impulse", Site::function})),
      particle_response_(builder.field({"end_response", "m/kg", "particle velocity of a unit impulse"})) {
  if (builder.scheme.choices.velocity_projection == VelocityProjection::consistent) {
    grid_change_ = builder.field({"end_change", "m/s²", "grid velocity by the forces", Site::function});
    particle_change_ = builder.field({"end_change", "m/s²", "particle velocity by the forces"});
  }
  const Particles& p = builder.state.particles;
  const std::size_t outer = side == Side::right ? p.size() - 1 : 0;
  parts_[0] = {outer, 1.0};
  if (p.size() == 1) return;
  const std::size_t next = side == Side::right ? outer - 1 : 1;
  const double spacing = outward(side) * (p.reference_position[outer] - p.reference_position[next]);
  const double beyond = 0.5 * p.reference_volume[outer] / spacing;
  parts_ = {{{outer, 1.0 + beyond}, {next, -beyond}}};
}

double BodyEnd::position(const State& state) const {
  double sum = 0.0;
  for (const auto& [p, weight] : parts_)
    sum += weight * (state.particles.reference_position[p] + state.particles.displacement[p]);
  return sum;
}

template <class Visit>
void BodyEnd::for_functions(const State& state, Visit visit) const {
  const std::size_t stencil = state.basis.stencil;
  for (const auto& [p, weight] : parts_)
    for (std::size_t k = 0; k < stencil; ++k)
      visit(static_cast<std::size_t>(state.basis.first[p]) + k, weight * state.basis.values[p * stencil + k]);
}

void BodyEnd::send_through_particles(State& state, std::vector<double>& grid,
                                     std::vector<double>& particles) const {
  const std::size_t stencil = state.basis.stencil;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double* n = &state.basis.values[p * stencil];
    const double* change = &grid[static_cast<std::size_t>(state.basis.first[p])];
    double sum = 0.0;
    for (std::size_t k = 0; k < stencil; ++k) sum += n[k] * change[k];
    particles[p] = sum;
  }
  discretisation_->project(state, particles, grid);
}

double BodyEnd::velocity(const State& state) const {
  double velocity = 0.0;
  for_functions(state, [&](std::size_t i, double value) { velocity += value * state.fields.velocity[i]; });
  return velocity;
}

BodyEnd::Response BodyEnd::find(State& state) const {
  Response found;
  auto& response = state[grid_response_];
  std::fill(response.begin(), response.end(), 0.0);
  for_functions(state, [&](std::size_t i, double value) { response[i] += value; });
  found.reaction = discretisation_->divide_by_mass(state, response);
  send_through_particles(state, response, state[particle_response_]);

  const GridFields& g = state.fields;
  for_functions(state, [&](std::size_t i, double value) { found.compliance += value * response[i]; });
  found.velocity = velocity(state);
  double acceleration = 0.0;
  if (!grid_change_) {  // by the symmetry of the response
    for (std::size_t i = 0; i < response.size(); ++i) acceleration += response[i] * g.force[i];
  } else {
    auto& change = state[grid_change_];
    change = g.acceleration;
    send_through_particles(state, change, state[particle_change_]);
    for_functions(state, [&](std::size_t i, double value) { acceleration += value * change[i]; });
  }
  found.velocity_before = found.velocity - state.kick * acceleration;
  return found;
}

double BodyEnd::push(State& state, const Response& response, double impulse) const {
  GridFields& g = state.fields;
  auto& velocity = state.particles.velocity;
  const auto& grid = state[grid_response_];
  const auto& particles = state[particle_response_];
  for (std::size_t i = 0; i < grid.size(); ++i) g.velocity[i] += impulse * grid[i];
  for (std::size_t p = 0; p < velocity.size(); ++p) velocity[p] += impulse * particles[p];
  if (discretisation_->keeps_momentum())
    for_functions(state, [&](std::size_t i, double value) { g.momentum[i] += impulse * value; });
  state.balance.impulse += impulse * (1.0 + response.reaction);
  return response.work(impulse);
}

Fields BodyEnd::reads() const {
  Fields fields = discretisation_->reads();
  fields.insert(fields.end(),
                {"particles.displacement"_field, "grid.force"_field, "grid.acceleration"_field});
  return fields;
}

Fields BodyEnd::changes() const {
  Fields fields{"particles.velocity"_field, "grid.velocity"_field, "balance.impulse"_field,
                "balance.dissipated"_field, "balance.external_work"_field};
  if (discretisation_->keeps_momentum()) fields.push_back("grid.momentum"_field);
  return fields;
}

Fields BodyEnd::writes() const {
  Fields fields{grid_response_, particle_response_};
  if (grid_change_) fields.insert(fields.end(), {grid_change_, particle_change_});
  return fields;
}

Stage BodyEnd::stage(std::string name, std::function<void(State&)> run) const {
  return {std::move(name), Phase::constraint, reads(), changes(), writes(), std::move(run)};
}

double EndPair::slow_down(State& left, State& right, double change) const {
  const auto a = a_.find(left), b = b_.find(right);
  const double impulse = change / (a.compliance + b.compliance);
  return a_.push(left, a, -impulse) + b_.push(right, b, impulse);
}

Coupling EndPair::coupling(std::string name, std::function<void(State&, State&)> run) const {
  return {.name = std::move(name),
          .phase = Phase::constraint,
          .reads = {a_.reads(), b_.reads()},
          .changes = {a_.changes(), b_.changes()},
          .writes = {a_.writes(), b_.writes()},
          .run = std::move(run)};
}

}  // namespace hompm::detail
