// An effect of one's own: drag, the body force b = −k |v| v, and a program that runs scenes with it.
#include <cmath>
#include <iostream>

#include <hompm/effects/registry.hpp>
#include <hompm/error.hpp>
#include <hompm/plan/plan.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/simulation/run.hpp>

namespace {

void join(const hompm::EffectSpec& spec, hompm::PlanBuilder& builder) {
  const double k = spec.number("coefficient");
  builder.add(hompm::Phase::acceleration, "drag", [k](hompm::State& state) {
    hompm::Particles& p = state.particles;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const double change = -state.kick * k * std::abs(p.velocity[i]) * p.velocity[i];
      state.balance.dissipated -= p.mass[i] * change * (p.velocity[i] + 0.5 * change);
      state.balance.impulse += p.mass[i] * change;
      p.velocity[i] += change;
    }
  });
}

hompm::EffectType drag() {
  return {.name = "drag",
          .meaning = "body force against the velocity, b = -coefficient |v| v",
          .parameters = {{.name = "coefficient", .unit = "1/m", .meaning = "of the drag", .minimum = 0.0}},
          .join = join};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    hompm::EffectCatalogue effects = hompm::effect_catalogue();
    effects.push_back(drag());
    const hompm::Scene scene = hompm::load_scene(argv[1], {}, effects);
    const hompm::RunResult result = hompm::run(scene, hompm::time_stepping(scene));
    std::cout << result.end.momentum / result.end.mass << ' ' << result.largest_residual << '\n';
  } catch (const hompm::Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
