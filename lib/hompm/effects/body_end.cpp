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

void join_own_stress(Side side, PlanBuilder& builder) {
  builder.add(Phase::end_stress, "held end: its marker carries its own stress", [side](State& state) {
    if (side == Side::right)
      state.right_stress = state.particles.stress.back();
    else
      state.left_stress = state.particles.stress.front();
  });
}

namespace {
EffectCatalogue own_stress_alone() {
  return {{.name = "own stress",
           .meaning = "an end that carries the stress of its own stretch, held by nothing",
           .parameters = {},
           .join = [](const EffectSpec& spec, PlanBuilder& builder) {
             if (builder.wants_end_stress) join_own_stress(side_of(spec), builder);
           }}};
}
}  // namespace

void leave_own_stress(Scene& scene) {
  static const EffectCatalogue catalogue = own_stress_alone();
  std::vector<EffectSpec> effects;
  for (const auto& [end, which] : {std::pair{scene.ends.left, "left"}, {scene.ends.right, "right"}}) {
    const bool own = std::ranges::any_of(scene.effects, [&, name = which](const EffectSpec& spec) {
      const EffectType& type = find_effect(scene, spec);
      return type.own_stress && (type.couples() || spec.text("end") == name);
    });
    if (own && end == End::free)
      effects.push_back(
          {.type = catalogue.front().name, .parameters = {{"end", std::string(which)}}, .origin = {}});
  }
  scene.effects = std::move(effects);
  scene.effect_types = &catalogue;
}

namespace {
/// Shut is a gap of less than this part of a cell: far above rounding and what relaxation moves in a step,
/// far below what the grid resolves.
bool is_shut(const State& state, double gap) { return gap <= 1e-3 * state.grid.cell_width(); }
}  // namespace

void carry_contact_stress(State& state, Side side, double gap) {
  if (!is_shut(state, gap)) return;
  const bool right = side == Side::right;
  const double own = right ? state.particles.stress.back() : state.particles.stress.front();
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
    : divide_by_mass_(builder.divide_by_mass),
      project_(builder.project),
      grid_response_(builder.state.fields.mass.size()),
      particle_response_(builder.state.particles.size()) {
  if (builder.scene.scheme.choices.velocity_projection == VelocityProjection::consistent) {
    grid_change_.resize(grid_response_.size());
    particle_change_.resize(particle_response_.size());
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

void BodyEnd::send_through_particles(const State& state, std::vector<double>& grid,
                                     std::vector<double>& particles) const {
  const std::size_t stencil = state.basis.stencil;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double* n = &state.basis.values[p * stencil];
    const double* change = &grid[static_cast<std::size_t>(state.basis.first[p])];
    double sum = 0.0;
    for (std::size_t k = 0; k < stencil; ++k) sum += n[k] * change[k];
    particles[p] = sum;
  }
  project_(state, particles, grid);
}

double BodyEnd::velocity_now(const State& state) const {
  double velocity = 0.0;
  for_functions(state, [&](std::size_t i, double value) { velocity += value * state.fields.velocity[i]; });
  return velocity;
}

void BodyEnd::find(const State& state) {
  std::fill(grid_response_.begin(), grid_response_.end(), 0.0);
  for_functions(state, [&](std::size_t i, double value) { grid_response_[i] += value; });
  reaction_ = divide_by_mass_(state, grid_response_);
  send_through_particles(state, grid_response_, particle_response_);

  const GridFields& g = state.fields;
  compliance_ = 0.0;
  for_functions(state, [&](std::size_t i, double value) { compliance_ += value * grid_response_[i]; });
  velocity_ = velocity_now(state);
  double acceleration = 0.0;
  if (grid_change_.empty()) {  // by the symmetry of the response
    for (std::size_t i = 0; i < grid_response_.size(); ++i) acceleration += grid_response_[i] * g.force[i];
  } else {
    grid_change_ = g.acceleration;
    send_through_particles(state, grid_change_, particle_change_);
    for_functions(state, [&](std::size_t i, double value) { acceleration += value * grid_change_[i]; });
  }
  velocity_before_ = velocity_ - state.kick * acceleration;
}

void BodyEnd::push(State& state, double impulse) const {
  GridFields& g = state.fields;
  auto& velocity = state.particles.velocity;
  for (std::size_t i = 0; i < grid_response_.size(); ++i) g.velocity[i] += impulse * grid_response_[i];
  for (std::size_t p = 0; p < velocity.size(); ++p) velocity[p] += impulse * particle_response_[p];
  for_functions(state, [&](std::size_t i, double value) { g.momentum[i] += impulse * value; });
  state.balance.impulse += impulse * (1.0 + reaction_);
}

void EndPair::find(const State& left, const State& right) {
  a_.find(left);
  b_.find(right);
}

double EndPair::slow_down(State& left, State& right, double change) const {
  const double impulse = change / (a_.compliance() + b_.compliance());
  a_.push(left, -impulse);
  b_.push(right, impulse);
  return a_.work(-impulse) + b_.work(impulse);
}

}  // namespace hompm::detail
