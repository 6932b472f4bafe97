// An effect of zero strength changes no bit of the results, and nothing allocates for one that is absent.
#include <cstring>
#include <string>

#include <hompm/effects/registry.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/scheme/scheme.hpp>
#include <hompm/simulation/simulation.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace {

std::string text(const std::string& scheme, const std::string& effect) {
  const bool manufactured = effect.find("manufactured") != effect.npos;
  return std::string(R"(
end_time = 1
body.length = 1
material = { law = "hencky", density = 1000, youngs_modulus = 1e5 }
)") +
         (manufactured
              ? ""
              : "ends.right = \"free\"\ninitial.velocity = { shape = \"sine\", amplitude = 0.3 }\n") +
         "effect = [ { type = \"mass-damping\", rate = 1 }" + (effect.empty() ? "" : ", { " + effect + " }") +
         " ]\nscheme = { name = \"" + scheme + R"(", cells = 16, particles_per_cell = 4, time_step = 1e-4 })";
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

}  // namespace

TEST_CASE("an effect of zero strength changes no bit") {
  const std::string effect = GENERATE(
      as<std::string>{},  //
      R"(type = "gravity", acceleration = 0)", R"(type = "gravity", acceleration = 0, ramp_time = 0.1)",
      R"(type = "traction", value = 0)", R"(type = "mass-damping", rate = 0)",
      R"(type = "local-damping", coefficient = 0)", R"(type = "viscosity", viscosity = 0)",
      R"(type = "bulk-viscosity", quadratic = 0, linear = 0)", R"(type = "manufactured", amplitude = 0)");
  const auto& scheme = GENERATE(from_range(hompm::scheme_table()));
  CAPTURE(effect, scheme.name);
  auto with = hompm::parse_scene(text(scheme.name, effect), "with", {});
  auto without = with;
  without.effects.resize(1);
  hompm::Simulation a(with, 1e-4);
  hompm::Simulation b(without, 1e-4);
  for (int step = 0; step < 200; ++step) {
    a.step();
    b.step();
  }
  const hompm::Snapshot s = a.snapshot(0.02);
  const hompm::Snapshot t = b.snapshot(0.02);
  CHECK(same_bits(s.displacement, t.displacement));
  CHECK(same_bits(s.velocity, t.velocity));
  CHECK(same_bits(s.stress, t.stress));
  CHECK(same_bits(s.stretch, t.stretch));
  const hompm::HistoryRow x = a.history(0.02);
  const hompm::HistoryRow y = b.history(0.02);
  CHECK(x.kinetic == y.kinetic);
  CHECK(x.stored == y.stored);
  CHECK(x.dissipated == y.dissipated);
  CHECK(x.impulse == y.impulse);
}

TEST_CASE("a law that never yields gives the bits of the elastic one, by every scheme and sequence") {
  const auto& scheme = GENERATE(from_range(hompm::scheme_table()));
  const std::string sequence = GENERATE("musl", "usl", "usf");
  auto plastic = hompm::parse_scene(text(scheme.name, ""), "plain", {});
  plastic.effects.clear();
  plastic.kinematics = hompm::Kinematics::infinitesimal;
  auto& choices = plastic.scheme.choices;
  if (choices.transfer != hompm::Transfer::apic &&
      choices.stress_update != hompm::StressUpdate::from_positions)
    choices.sequence = sequence == "musl"  ? hompm::Sequence::musl
                       : sequence == "usl" ? hompm::Sequence::usl
                                           : hompm::Sequence::usf;
  auto elastic = plastic;
  elastic.material.law = "linear";
  plastic.material.law = "elastoplastic";
  plastic.material.parameters = {{"yield_stress", 1e300}, {"tangent_modulus", 0.0}};
  CAPTURE(scheme.name, sequence);
  hompm::Simulation a(plastic, 1e-5), b(elastic, 1e-5);
  for (int step = 0; step < 100; ++step) {
    a.step();
    b.step();
  }
  CHECK(same_bits(a.state().particles.velocity, b.state().particles.velocity));
  CHECK(same_bits(a.state().particles.stress, b.state().particles.stress));
  CHECK(a.history(1e-3).stored == b.history(1e-3).stored);
}

TEST_CASE("no effect is forgotten by the test of zero strength") {
  CHECK(hompm::effect_catalogue().size() ==
        7 + 5);  // what holds ends and couples bodies are conditions, without a strength
}

TEST_CASE("what no effect calls for is not in the plan, nor in the state") {
  const auto& scheme = GENERATE(from_range(hompm::scheme_table()));
  auto scene = hompm::parse_scene(text(scheme.name, ""), "plain", {});
  scene.effects.clear();
  const hompm::Simulation simulation(scene, 1e-4);
  CHECK(simulation.plan().adds_stress() == (scheme.name == "high-order"));  // markers at free ends
  CHECK(simulation.plan().stored_energies.capacity() == 0);
  CHECK(simulation.plan().potentials.capacity() == 0);
  for (const auto phase : {hompm::Phase::external_force, hompm::Phase::damping_force, hompm::Phase::work})
    CHECK(simulation.plan()[phase].empty());
  for (const auto& phase : simulation.plan().phases)
    for (const auto& stage : phase) CHECK(stage.called_by.starts_with("scheme " + scheme.name + " (plain:"));
}
