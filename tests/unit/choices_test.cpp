// The choices of a scheme that a scene makes itself, and what does not go together.
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/numerics/smooth_step.hpp>
#include <hompm/scheme/scheme.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/scenes.hpp"

using hompm::test::built_in;
using hompm::test::contains;

namespace {

using Keys = std::vector<std::pair<std::string, std::string>>;

hompm::Scene large(const std::string& case_name, const Keys& keys) {
  std::vector<hompm::Override> overrides;
  for (const auto& [key, value] : keys) overrides.push_back({key, value, "--set " + key});
  return hompm::load_builtin(case_name, "large", overrides);
}

hompm::RunResult run(const std::string& case_name, const Keys& keys) {
  const auto scene = large(case_name, keys);
  return hompm::run(scene, hompm::time_stepping(scene));
}

}  // namespace

TEST_CASE("the smooth step joins 0 and 1, symmetric about its middle") {
  using hompm::numerics::smooth_step;
  CHECK(smooth_step(-1.0) == 0.0);
  CHECK(smooth_step(0.5) == 0.5);
  CHECK(smooth_step(2.0) == 1.0);
  for (const double x : {0.0, 0.1, 0.25, 0.4})
    CHECK(std::abs(smooth_step(x) + smooth_step(1.0 - x) - 1.0) < 1e-13);  // rounding of coefficients to 540
  CHECK(hompm::numerics::ramp(0.1, 0.0) == 1.0);
  CHECK(hompm::numerics::ramp(0.1, 0.2) == 0.5);
}

TEST_CASE("gravity that is ramped up is external work, and the balances close") {
  const auto result = run("column", {{"scheme.name", "high-order"},
                                     {"scheme.cells", "16"},
                                     {"effect.gravity.ramp_time", "0.2"},
                                     {"end_time", "0.4"}});
  CHECK(result.end.gravity == 0.0);
  CHECK(result.end.external_work > 0.0);
  // Work is summed by the midpoint rule in time: second order, and the step is 1e-4 s.
  CHECK(result.largest_residual < 1e-3 * result.end.external_work);
}

TEST_CASE("conserve says what the reconstructed density keeps") {
  const auto state_of = [](const std::string& kept) {
    const auto scene = built_in("bar", "large",
                                {{"scheme.name", "high-order"},
                                 {"scheme.cells", "8"},
                                 {"scheme.conserve", kept},
                                 {"scheme.courant", "0.2"},
                                 {"end_time", "1"}});
    const auto stepping = hompm::time_stepping(scene);
    hompm::Simulation simulation(scene, stepping.time_step);
    for (int step = 0; step < stepping.steps; ++step) simulation.step();
    const auto& mass = simulation.state().fields.mass;
    return std::pair(std::accumulate(mass.begin(), mass.end(), 0.0) - simulation.state().total_mass,
                     simulation.history(1.0).momentum_residual);
  };
  const auto nothing = state_of("nothing");
  CHECK(std::abs(nothing.first) > 1e-10);
  CHECK(std::abs(nothing.second) > 1e-6);
  CHECK(std::abs(state_of("cell-mass").first) < 1e-12);  // rounding of 25 kg/m²
  CHECK(std::abs(state_of("momentum").second) < 1e-12);  // of 16 kg/(m s)
  const auto column = run("column", {{"scheme.name", "high-order"},
                                     {"scheme.degree", "2"},
                                     {"scheme.cells", "16"},
                                     {"scheme.particles_per_cell", "8"},
                                     {"scheme.conserve", "momentum"},
                                     {"end_time", "0.2"}});
  CHECK(column.largest_momentum_residual < 1e-9);  // of 500 kg/(m s), the cut span ties functions
}

TEST_CASE("a density that a shift to the mass of its cell would make negative stops the run") {
  const auto scene =
      built_in("bar", "large",
               {{"scheme.name", "tielen2017"}, {"scheme.cells", "4"}, {"scheme.conserve", "cell-mass"}});
  hompm::Simulation simulation(scene, 1e-4);
  simulation.step();
  // A density 2^(i/2) at particles that have 1: the last cell takes the difference of its mean, 115, from its
  // left end, where there are 64.
  auto& stretch = simulation.state().particles.stretch;
  for (std::size_t i = 0; i < stretch.size(); ++i) stretch[i] = std::exp2(-0.5 * static_cast<double>(i));
  CHECK_THAT(hompm::test::message_of<hompm::InvalidRun>([&] { simulation.step(); }),
             contains("the density spline is not positive"));
}

TEST_CASE("choices may be made with any scheme that has what they need") {
  const auto keys = GENERATE(
      Keys{{"scheme.name", "bspline"},
           {"scheme.velocity_projection", "least-squares"},
           {"scheme.transfer", "pic"}},
      Keys{{"scheme.name", "bspline"}, {"scheme.quadrature", "moving-least-squares"}},
      Keys{{"scheme.name", "bspline"}, {"scheme.quadrature", "mixed"}, {"scheme.degree", "1"}},
      Keys{{"scheme.name", "tielen2017"}, {"scheme.conserve", "cell-momentum"}},
      Keys{{"scheme.name", "high-order"}, {"scheme.quadrature", "taylor-least-squares"}},
      Keys{{"scheme.name", "bspline"}, {"scheme.stress_update", "from-positions"}, {"scheme.degree", "5"}},
      Keys{{"scheme.name", "tielen2017"}, {"scheme.time_integrator", "leapfrog"}, {"scheme.markers", "true"}},
      Keys{{"scheme.name", "high-order"}, {"scheme.quadrature", "reconstructed"}, {"scheme.degree", "4"}},
      Keys{{"scheme.name", "high-order"}, {"scheme.acceleration_mass", "lumped"}});
  Keys all = keys;
  all.insert(all.end(), {{"scheme.cells", "16"}, {"end_time", "0.2"}});
  const auto result = run("bar", all);
  CHECK(result.largest_residual < 1e-2 * result.start.kinetic);
}

TEST_CASE("mass damping takes the momentum of the scheme's own projection") {
  // A rigid body at 1 m/s, b = -2 v: v decays with exp(-2 t), to the order of the step.
  for (const std::string name : {"classical", "bspline", "tielen2017", "high-order"})
    for (const std::string projection : {"", "least-squares"}) {
      std::string text = R"(
end_time = 0.1
body.length = 1
material = { law = "rate", density = 1, youngs_modulus = 1 }
ends = { left = "free", right = "free" }
effect = [ { type = "mass-damping", rate = 2.0 }, { type = "gravity", acceleration = 1.0 } ]
[scheme]
cells = 8
particles_per_cell = 4
time_step = 1e-3
name = ")" + name + "\"\n";
      if (!projection.empty()) text += "velocity_projection = \"" + projection + "\"\n";
      const auto scene = hompm::parse_scene(text, "block.toml", {});
      const auto result = hompm::run(scene, hompm::time_stepping(scene));
      INFO(name << ' ' << projection);
      CHECK(std::abs(result.end.momentum - 0.5 * (1.0 - std::exp(-0.2))) < 2e-3 * result.end.momentum);
    }
}

TEST_CASE("choices that do not go together are refused, at the one the scene made") {
  const auto refusal = [](const Keys& keys) {
    return hompm::test::message_of<hompm::SceneError>([&] { large("bar", keys); });
  };
  const Keys bspline{{"scheme.name", "bspline"}};
  const auto with = [&](Keys keys, const std::string& key, const std::string& value) {
    keys.emplace_back(key, value);
    return refusal(keys);
  };
  for (const auto& [key, value] : Keys{{"scheme.acceleration_mass", "consistent"},
                                       {"scheme.velocity_projection", "consistent"},
                                       {"scheme.free_end", "cut-span"},
                                       {"scheme.conserve", "cell-mass"}})
    CHECK_THAT(with(bspline, key, value),
               contains("`" + key + "`") && contains("needs reconstructed fields"));
  CHECK_THAT(with(bspline, "scheme.relaxation_rate", "1"), contains("`scheme.stress_update` must be"));
  for (const std::string name : {"mixed", "classical"})
    CHECK_THAT(with({{"scheme.name", name}, {"scheme.quadrature", "mixed"}}, "scheme.free_end", "cut-span"),
               contains("\"taylor-least-squares\""));
  CHECK_THAT(with(bspline, "scheme.quadrature", "mixed"), contains("needs `scheme.degree` = 1"));
  CHECK_THAT(with({{"scheme.name", "mls"}}, "scheme.degree", "4"),
             contains("from 1 to 3 with the scheme mls"));
  CHECK_THAT(
      with({{"scheme.name", "bspline"}, {"scheme.degree", "4"}}, "scheme.quadrature", "moving-least-squares"),
      contains("`scheme.degree` must be at most 3, not 4"));
  CHECK_THAT(with({{"scheme.name", "tls"}, {"scheme.conserve", "cell-momentum"}},
                  "scheme.velocity_projection", "lumped"),
             contains("`scheme.conserve`") && contains("`scheme.velocity_projection` must be"));
  const Keys tielen{{"scheme.name", "tielen2017"}};
  CHECK_THAT(with(tielen, "scheme.conserve", "momentum"), contains("lumped mass conserves momentum"));
  CHECK_THAT(with({{"scheme.name", "tielen2017"}, {"scheme.velocity_projection", "lumped"}},
                  "scheme.free_end", "extension"),
             contains("ties functions of a consistent mass"));
}

TEST_CASE("kicks and drifts of every integrator make one step, and read the same backwards") {
  using enum hompm::TimeIntegrator;
  for (const auto integrator : {euler_cromer, leapfrog, blanes_moan}) {
    const auto& [kicks, drifts] = hompm::splitting(integrator);
    for (const auto& parts : {kicks, drifts}) {
      CHECK(std::abs(std::accumulate(parts.begin(), parts.end(), -1.0)) < 1e-15);  // rounding of a few sums
      CHECK(std::equal(parts.begin(), parts.end(), parts.rbegin()));
    }
  }
}

TEST_CASE("cells without particles share the mass of the one before them") {
  auto scene = hompm::test::free_body({{"scheme.name", "high-order"}, {"scheme.conserve", "cell-mass"}});
  hompm::Simulation simulation(scene, 1e-3);
  auto& state = simulation.state();
  // A twentieth of a cell to the right: the free end is then in a cell of its own.
  for (double& v : state.particles.velocity) v = 0.05 / 16.0 / 1e-3;
  simulation.step();
  simulation.plan().run(hompm::Phase::geometry, state);
  const auto& mass = state.fields.mass;
  CHECK(std::abs(std::accumulate(mass.begin(), mass.end(), -state.total_mass)) < 1e-14);  // of 1 kg/m²
}

TEST_CASE("any relaxation rate above zero relaxes") {
  const auto relaxes = [](const std::string& rate) {
    const auto scene =
        built_in("bar", "large", {{"scheme.name", "high-order"}, {"scheme.relaxation_rate", rate}});
    const hompm::Simulation simulation(scene, 1e-4);
    for (const auto& phase : simulation.plan().phases)
      for (const auto& stage : phase)
        if (stage.name.find("relax") != std::string::npos) return true;
    return false;
  };
  CHECK_FALSE(relaxes("0"));
  CHECK(relaxes("1e-3"));
}

TEST_CASE("a position update before the projection moves as usl does and strains as musl does") {
  // One step from the same start: later ones differ.
  const auto one_step = [](const std::string& sequence, const std::string& update,
                           const std::string& stress) {
    return run("bar", {{"scheme.name", "bspline"},
                       {"scheme.cells", "8"},
                       {"scheme.sequence", sequence},
                       {"scheme.position_update", update},
                       {"scheme.stress_update", stress},
                       {"initial.displacement.shape", "sine"},
                       {"initial.displacement.amplitude", "0.1"},
                       {"scheme.time_step", "1e-3"},
                       {"end_time", "1e-3"}})
        .final;
  };
  for (const std::string stress : {"incremental", "from-stretch"}) {
    const auto mixed = one_step("musl", "before-projection", stress);
    const auto musl = one_step("musl", "after-projection", stress);
    CHECK(mixed.displacement == one_step("usl", "after-projection", stress).displacement);
    CHECK(mixed.displacement != musl.displacement);
    CHECK(mixed.stress == musl.stress);
    CHECK(mixed.velocity == musl.velocity);
  }
  CHECK(contains(hompm::test::message_of<hompm::SceneError>(
                     [&] { one_step("usl", "before-projection", "incremental"); }),
                 "`scheme.position_update` = \"before-projection\" is of `scheme.sequence` \"musl\""));
}

TEST_CASE("essential conditions set after the solution hold the ends, and the momentum balance closes") {
  const auto bar = [](const std::string& conditions) {
    return run("bar", {{"scheme.name", "tielen2017"},
                       {"scheme.cells", "8"},
                       {"scheme.acceleration_mass", "consistent"},
                       {"scheme.essential_conditions", conditions},
                       {"scheme.time_step", "1e-2"},
                       {"end_time", "2"}});
  };
  const auto after = bar("after-solution");
  CHECK(after.end.momentum != bar("in-system").end.momentum);
  // Both ends push: their impulses are what the momentum, 15.9 kg/(m s) at the start, loses. The masses of
  // particles and of the reconstructed density agree to the order of the midpoint rule.
  CHECK(std::abs(after.end.impulse) > 0.1);
  CHECK(after.largest_momentum_residual < 2.0 * bar("in-system").largest_momentum_residual + 1e-12);
}
