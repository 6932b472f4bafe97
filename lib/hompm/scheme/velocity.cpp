#include <hompm/scheme/velocity.hpp>

namespace hompm::detail {

void accelerate_lumped(State& state) {
  GridFields& g = state.fields;
  for (std::size_t i = 0; i < g.mass.size(); ++i)
    g.acceleration[i] = g.mass[i] > 0.0 ? g.force[i] / g.mass[i] : 0.0;
  const auto fix = [&](std::size_t i) {
    g.acceleration[i] = 0.0;
    state.balance.impulse -= state.kick * g.force[i];
  };
  if (state.ends.left == End::fixed) fix(0);
  if (state.ends.right == End::fixed) fix(g.mass.size() - 1);
}

double kinetic_energy(const Particles& particles) {
  double sum = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p)
    sum += 0.5 * particles.mass[p] * particles.velocity[p] * particles.velocity[p];
  return sum;
}

}  // namespace hompm::detail
