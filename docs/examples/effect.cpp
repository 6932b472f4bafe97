// An effect of one's own, with a field of its own: drag on the particles, and the energy that it takes.
// Prints:
//   drag took 1.39544 J/m^2
#include <cmath>
#include <iostream>

#include <hompm/kit/kit.hpp>

using hompm::operator""_field;

void join_drag(const hompm::EffectSpec& spec, const hompm::PlanBuilder& builder) {
  const double k = spec.number("coefficient");
  const hompm::Field taken =
      builder.field({"drag_energy", "J/m^2", "taken by drag", hompm::Site::particle, true, true});
  builder.add({.name = "drag",
               .phase = hompm::Phase::acceleration,
               .reads = {"particles.mass"_field},
               .changes = {"particles.velocity"_field, taken, "balance.dissipated"_field},
               .run = [k, taken](hompm::State& state) {
                 hompm::Particles& p = state.particles;
                 for (std::size_t i = 0; i < p.size(); ++i) {  // dv = -k |v| v dt
                   const double change = -state.kick * k * std::abs(p.velocity[i]) * p.velocity[i];
                   const double energy = -p.mass[i] * change * (p.velocity[i] + 0.5 * change);
                   p.velocity[i] += change;
                   state[taken][i] += energy;
                   state.balance.dissipated += energy;
                 }
               }});
}

int main() {
  hompm::EffectCatalogue effects = hompm::effect_catalogue();
  effects.push_back({"drag",
                     "body force -coefficient |v| v",
                     {{.name = "coefficient", .unit = "1/m", .meaning = "of the drag", .minimum = 0.0}},
                     join_drag});
  const std::string text =
      hompm::builtin_scenes().front().text + "[[effect]]\ntype = \"drag\"\ncoefficient = 0.1\n";
  const hompm::Scene scene = hompm::parse_scene(text, "drag.toml", {}, effects);
  const hompm::RunResult result = hompm::run(scene, hompm::time_stepping(scene));
  std::cout << "drag took " << result.end.dissipated << " J/m^2\n";
}
