#include <vector>

#include <hompm/scheme/velocity.hpp>

namespace hompm::detail {

void divide_by_mass(const std::vector<double>& field, const std::vector<double>& mass,
                    std::vector<double>& quotient) {
  const std::size_t count = mass.size();
  const double* q = field.data();
  const double* m = mass.data();
  double* result = quotient.data();
  for (std::size_t i = 0; i < count; ++i) result[i] = m[i] > 0.0 ? q[i] / m[i] : 0.0;
}

double velocity_of(const State& state, const std::vector<double>& momentum, std::vector<double>& velocity) {
  double reaction = 0.0;
  if (state.ends.left == End::fixed) reaction -= momentum.front();
  if (state.ends.right == End::fixed) reaction -= momentum.back();
  divide_by_mass(momentum, state.fields.mass, velocity);
  if (state.ends.left == End::fixed) velocity.front() = 0.0;
  if (state.ends.right == End::fixed) velocity.back() = 0.0;
  return reaction;
}

void accelerate_lumped(State& state) {
  GridFields& g = state.fields;
  divide_by_mass(g.force, g.mass, g.acceleration);
  const auto fix = [&](std::size_t i) {
    g.acceleration[i] = 0.0;
    state.balance.impulse -= state.kick * g.force[i];
  };
  if (state.ends.left == End::fixed) fix(0);
  if (state.ends.right == End::fixed) fix(g.mass.size() - 1);
}

double divide_impulses(const State& state, std::vector<double>& field) {
  double reaction = 0.0;
  const auto hold = [&](double& impulse) {
    reaction -= impulse;
    impulse = 0.0;
  };
  if (state.ends.left == End::fixed) hold(field.front());
  if (state.ends.right == End::fixed) hold(field.back());
  divide_by_mass(field, state.fields.mass, field);
  return reaction;
}

double kinetic_energy(const Particles& particles) {
  const std::size_t count = particles.size();
  const double* mass = particles.mass.data();
  const double* velocity = particles.velocity.data();
  double sum = 0.0;
  for (std::size_t p = 0; p < count; ++p) sum += 0.5 * mass[p] * velocity[p] * velocity[p];
  return sum;
}

}  // namespace hompm::detail
