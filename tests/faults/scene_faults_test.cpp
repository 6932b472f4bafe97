// Faults of scenes, time steps, guards and of what a run says, each with other members of its kind. The
// numbers are those of the list of faults that issue 14 works off.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <hompm/effects/registry.hpp>
#include <hompm/error.hpp>
#include <hompm/kit/output/run_report.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/verify/judge.hpp>
#include <hompm/simulation/run.hpp>
#include <hompm/simulation/warnings.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"

namespace {

using hompm::operator""_field;
using hompm::test::contains;
using hompm::test::message_of;
using Keys = std::vector<std::pair<std::string, std::string>>;

const std::string linear_bar = R"(
end_time = 1.0
body = { length = 1.0 }
material = { law = "linear", density = 1.0, youngs_modulus = 1.0 }
ends = { left = "fixed", right = "free" }
scheme = { name = "bspline", cells = 8, particles_per_cell = 4, step_fraction = 0.2 }
)";

hompm::Scene scene_of(const std::string& text, const Keys& keys = {}) {
  std::vector<hompm::Override> overrides;
  for (const auto& [key, value] : keys) overrides.push_back({key, value, "--set " + key + "=" + value});
  return hompm::parse_scene(text, "scene.toml", overrides);
}

std::string refusal(const std::string& text, const Keys& keys = {}) {
  return message_of<hompm::SceneError>([&] {
    const hompm::Scene scene = scene_of(text, keys);
    hompm::run(scene, hompm::time_stepping(scene));
  });
}

hompm::RunResult result_of(const std::string& text, const Keys& keys = {}) {
  const hompm::Scene scene = scene_of(text, keys);
  return hompm::run(scene, hompm::time_stepping(scene));
}

std::vector<std::string> codes(const std::vector<hompm::Warning>& warnings) {
  std::vector<std::string> all;
  for (const hompm::Warning& warning : warnings) all.push_back(warning.code);
  return all;
}

std::vector<std::string> codes_before(const std::string& text, const Keys& keys = {}) {
  const hompm::Scene scene = scene_of(text, keys);
  return codes(hompm::warnings_before(scene, hompm::time_stepping(scene)));
}

using Codes = std::vector<std::string>;

std::string effect(const std::string& type, const std::string& parameters) {
  return "[[effect]]\ntype = \"" + type + "\"\n" + parameters + "\n";
}

}  // namespace

TEST_CASE("fault 2: a part of a critical step that nothing bounds is refused, and says what to give",
          "[faults]") {
  const std::string single = R"(
end_time = 1.0
body = { length = 1.0 }
material = { law = "linear", density = 1.0, youngs_modulus = 1.0 }
ends = { left = "free", right = "free" }
initial.velocity = { shape = "uniform", amplitude = 0.1 }
scheme = { name = "classical", cells = 1, particles_per_cell = 1, step_fraction = 0.5 }
)";
  CHECK(contains(refusal(single), "scene.toml:7:"));
  CHECK(contains(refusal(single), "scheme.step_fraction: that makes a time step of no end for a run of 1 s"));
  CHECK(contains(refusal(single), "Give scheme.time_step (s) instead, 0.01 for a hundred steps"));
  const std::string held = R"(
end_time = 1.0
body = { length = 1.0 }
material = { law = "rate", density = 1.0, youngs_modulus = 1.0 }
scheme = { name = "classical", cells = 1, particles_per_cell = 2, step_fraction = 0.5 }
)";
  CHECK(contains(refusal(held), "Give scheme.time_step (s)"));
  for (const std::string modulus : {"1e-300", "1e-30", "2.3e-308"})
    for (const std::string key : {"step_fraction", "courant"})
      CHECK(contains(refusal(linear_bar, {{"material.youngs_modulus", modulus}, {"scheme." + key, "0.5"}}),
                     "Give scheme.time_step (s)"));
  // With that step they run to the end.
  for (const std::string& text : {single, held}) {
    const auto result = result_of(text, {{"scheme.time_step", "0.01"}});
    CHECK(result.steps == 100);
    CHECK(result.end.time == 1.0);
  }
  const auto flown = result_of(single, {{"scheme.time_step", "0.01"}});
  // A hundred sums of 1e-3, each rounded.
  CHECK(std::abs(flown.final.displacement.front() - 0.1) < 1e-15);
  const hompm::Scene scene = scene_of(single, {{"scheme.time_step", "0.01"}});
  const auto stepping = hompm::time_stepping(scene);
  const std::optional<hompm::ErrorReport> none;
  CHECK(contains(hompm::run_summary({scene, stepping, flown, none, "x"}), "; no step is critical\n"));
}

TEST_CASE("a scene without a time step is refused by the library, too", "[faults]") {
  hompm::Scene scene = scene_of(linear_bar);
  scene.scheme.step_fraction.reset();
  CHECK(contains(message_of<hompm::SceneError>([&] { hompm::time_stepping(scene); }),
                 "the time step is missing: give one of"));
  hompm::EffectSpec spec{
      .type = "gravity", .parameters = {{"acceleration", std::string("down")}}, .origin = {"here"}};
  CHECK(message_of<hompm::SceneError>([&] { return spec.number("acceleration"); }) ==
        "here: the effect gravity needs the number `acceleration`");
  CHECK(message_of<hompm::SceneError>([&] { return spec.text("end"); }) ==
        "here: the effect gravity needs the word `end`");
}

TEST_CASE("fault 3: no rest while a load is still to change", "[faults]") {
  const std::string damped = linear_bar + "rest.speed = 1e-4\n" + effect("mass-damping", "rate = 6.0");
  const std::vector<std::pair<std::string, double>> loads{
      {effect("gravity", "acceleration = -0.01\nramp_time = 15.0"), 15.0},
      {effect("traction", "value = 0.01\nramp_time = 15.0"), 15.0},
      {effect("traction", "value = 0.01\nramp_time = 8.0\nduration = 16.0"), 16.0},
      {effect("gravity", "acceleration = 0.01\nfrequency = 0.01\nduration = 14.0\nramp_time = 1.0"), 14.0},
      {effect("piston", "end = \"right\"\nvelocity = 1e-3\nramp_time = 6.0\nduration = 14.0"), 14.0}};
  for (const auto& [load, settled] : loads) {
    const auto result = result_of(damped + load, {{"end_time", "40"}});
    CHECK(result.at_rest);
    CHECK(result.end.time >= settled + 2.0);  // a wave there and back
  }
  // Of the load in full: what is left creeps with up to 1e-4 m/s and decays with (π/2)²/6 a second, 2.4e-4 m
  // of displacement, of which π/2 is strain at the fixed end.
  const auto pulled = result_of(damped + loads[1].first, {{"end_time", "40"}});
  CHECK(std::abs(pulled.final.stress.front() - 0.01) < 4e-4);

  SECTION("nor before the time asked for") {
    const auto late = result_of(damped, {{"end_time", "10"}, {"rest.earliest", "7.5"}});
    CHECK(late.at_rest);
    CHECK(late.end.time >= 7.5);
    CHECK(result_of(damped, {{"end_time", "10"}}).end.time < 3.0);
  }
  SECTION("and it is told where there can be none") {
    const std::string forever = damped + effect("traction", "value = 1e-9\nfrequency = 0.5");
    CHECK(codes_before(forever, {{"end_time", "10"}}) == Codes{"no-rest"});
    CHECK_FALSE(result_of(forever, {{"end_time", "10"}}).at_rest);
    CHECK(codes_before(damped + loads[0].first, {{"end_time", "10"}}) == Codes{"no-rest"});
    CHECK(codes_before(damped + effect("piston", "end = \"right\"\nvelocity = 1e-9")) == Codes{"no-rest"});
    CHECK(codes_before(damped + effect("traction", "value = 0.0\nfrequency = 0.5")).empty());
  }
}

TEST_CASE("fault 3: no rest while a gap is about to close", "[faults]") {
  const std::string flight = R"(
end_time = 6.0
material = { law = "neo-hookean", density = 1.0, youngs_modulus = 1.0 }
ends = { left = "free", right = "free" }
initial.velocity = { shape = "uniform", amplitude = 1e-3 }
rest.speed = 2e-3
scheme = { name = "bspline", cells = 8, particles_per_cell = 4, step_fraction = 0.2 }
)";
  const std::string one = flight + "body = { length = 1.0 }\n";
  const auto wall = [](const std::string& end, const std::string& position) {
    return effect("wall", "end = \"" + end + "\"\nposition = " + position);
  };
  // At 1e-3 m/s it gets there at 5 s, and flies back; the other wall it leaves behind, or reaches after the
  // end.
  CHECK(result_of(one + wall("right", "1.005")).end.time > 5.0);
  CHECK(result_of(one + wall("left", "-0.004")).end.time < 3.0);
  CHECK(result_of(one + wall("right", "1.02")).end.time < 3.0);
  const std::string two = flight + R"(
[[body]]
length = 1.0
[[body]]
length = 1.0
start = 1.005
initial.velocity.amplitude = 0.0
)" + effect("contact", "");
  CHECK(result_of(two).end.time > 5.0);
}

TEST_CASE("fault 4: a start beyond a wall is refused with every law and formulation", "[faults]") {
  const std::string wall =
      linear_bar + "initial.displacement = { shape = \"linear\", amplitude = 0.0, gradient = 0.025 }\n" +
      effect("wall", "position = 1.02");
  const std::string message = "the wall at 1.02 m is inside the body, whose end is at 1.025";
  for (const std::string scheme : {"bspline", "total-lagrangian", "high-order", "tielen2017"})
    for (const std::string law : {"linear", "neo-hookean"})
      CHECK(contains(refusal(wall, {{"scheme.name", scheme}, {"material.law", law}}), message));
  const std::string left = R"(
end_time = 1.0
body = { length = 1.0 }
material = { law = "linear", density = 1.0, youngs_modulus = 1.0 }
ends = { left = "free", right = "free" }
initial.displacement = { shape = "uniform", amplitude = -0.1 }
scheme = { name = "bspline", cells = 8, particles_per_cell = 4, step_fraction = 0.2 }
)" + effect("wall", "end = \"left\"\nposition = -0.05");
  CHECK(contains(refusal(left), "`position` must be at most that"));
  CHECK(refusal(wall, {{"effect.wall.position", "1.025"}}).empty());
}

TEST_CASE("fault 4: what gives energy where it can only take it is told, and stopped when it gives all",
          "[faults]") {
  hompm::RunExtremes extremes;
  extremes.largest_energy = 1.0;
  extremes.least_dissipated = -0.005;
  CHECK(hompm::warnings_after(extremes, 0.0).empty());
  extremes.least_dissipated = -0.02;
  CHECK(codes(hompm::warnings_after(extremes, 0.0)) == Codes{"energy-made"});
  CHECK(hompm::warnings_after(extremes, 3.0).empty());

  const hompm::Scene scene =
      scene_of(linear_bar + "initial.velocity = { shape = \"linear\", amplitude = 0.0, gradient = 0.1 }\n");
  const auto make = [](double energy) {
    hompm::RunObserver observer;
    observer.start = [energy](hompm::Simulation& simulation) {
      simulation.plan().phases[static_cast<std::size_t>(hompm::Phase::work)].push_back(
          {.name = "gives", .phase = hompm::Phase::work, .run = [energy](hompm::State& state) {
             state.balance.dissipated -= energy;
           }});
    };
    return observer;
  };
  const auto stepping = hompm::time_stepping(scene);
  CHECK(codes(hompm::run(scene, stepping, make(1e-6)).warnings) == Codes{"energy-made"});
  CHECK(contains(message_of<hompm::InvalidRun>([&] { hompm::run(scene, stepping, make(1e-3)); }),
                 "what can only take energy (walls, contact, dampings, viscosities, plasticity) gave "));
  CHECK(hompm::run(scene, stepping).warnings.empty());
}

TEST_CASE("fault 4: what one effect gives is seen though another takes more", "[faults]") {
  hompm::EffectCatalogue effects = hompm::effect_catalogue();
  hompm::EffectType books;
  books.name = "books";
  books.parameters = {{.name = "energy", .unit = "J/m^2", .meaning = "taken in a step"}};
  books.join = [](const hompm::EffectSpec& spec, const hompm::PlanBuilder& builder) {
    builder.add({.name = "books",
                 .phase = hompm::Phase::work,
                 .changes = {"balance.dissipated"_field},
                 .run = [energy = spec.number("energy")](hompm::State& state) {
                   state.balance.dissipated += energy;
                 }});
  };
  effects.push_back(books);
  const std::string moving =
      linear_bar + "initial.velocity = { shape = \"linear\", amplitude = 0.0, gradient = 0.1 }\n";
  const auto result = [&](const std::string& one, const std::string& other) {
    const hompm::Scene scene =
        hompm::parse_scene(moving + effect("books", "energy = " + one) + effect("books", "energy = " + other),
                           "scene.toml", {}, effects);
    return hompm::run(scene, hompm::time_stepping(scene));
  };
  CHECK(codes(result("1e-6", "2e-6").warnings).empty());
  CHECK(codes(result("2e-6", "-1e-6").warnings) == Codes{"energy-made"});
  CHECK(contains(message_of<hompm::InvalidRun>([&] { result("2e-3", "-1e-3"); }),
                 "; by books; take a smaller"));
}

TEST_CASE("fault 5: loads finer than the time step are refused or told", "[faults]") {
  const Keys step{{"scheme.time_step", "0.01"}, {"end_time", "0.9"}};
  const auto pull = [](const std::string& more) {
    return linear_bar + effect("traction", "value = 1e-3\n" + more);
  };
  for (const std::string frequency : {"26.0", "49.0", "50.0", "98.0", "100.0", "102.0", "1e9"})
    CHECK(contains(refusal(pull("frequency = " + frequency), step), "the period of its frequency, "));
  const std::string told = refusal(pull("frequency = 98.0"), step);
  CHECK(contains(told,
                 "scene.toml:7:1: the effect traction: the period of its frequency, 0.01020408163265306 s"));
  CHECK(contains(told, " time steps of 0.01 s; take scheme.time_step = 0.00051020408163265"));
  CHECK(contains(told, " or less, for 20 steps"));
  CHECK(codes_before(pull("frequency = 24.0"), step) == Codes{"coarse-load"});
  CHECK(codes_before(pull("frequency = 5.0"), step).empty());
  CHECK(contains(refusal(pull("duration = 0.03"), step), "its duration, 0.03 s, is 3"));
  CHECK(contains(refusal(pull("duration = 1e-5"), step), "its duration"));
  CHECK(codes_before(pull("duration = 0.1"), step) == Codes{"coarse-load"});
  CHECK(codes_before(pull("ramp_time = 0.02"), step) == Codes{"coarse-load"});
  CHECK(codes_before(pull("ramp_time = 0.04"), step).empty());
  for (const std::string& other : {effect("gravity", "acceleration = 1.0\nfrequency = 60.0"),
                                   effect("piston", "end = \"right\"\nvelocity = 1e-3\nfrequency = 60.0")})
    CHECK(contains(refusal(linear_bar + other, step), "take scheme.time_step = "));
  CHECK(refusal(linear_bar + effect("traction", "value = 0.0\nfrequency = 98.0"), step).empty());
}

TEST_CASE("fault 5: initial fields finer than particles and cells are refused or told", "[faults]") {
  for (const std::string field : {"velocity", "displacement"}) {
    const std::string scene =
        linear_bar + "initial." + field + " = { shape = \"sine\", amplitude = 1e-6, mode = 1 }\n";
    const std::string key = "initial." + field + ".mode";
    const auto mode = [&](const std::string& value) { return Keys{{"ends.right", "fixed"}, {key, value}}; };
    CHECK(codes_before(scene, mode("8")).empty());
    CHECK(codes_before(scene, mode("9")) == Codes{"coarse-mode"});
    CHECK(codes_before(scene, mode("32")) == Codes{"coarse-mode"});
    CHECK(contains(refusal(scene, mode("33")),
                   "--set " + key + "=33: `" + key + "` = 33, half waves over 8 cells and 32"));
    CHECK(contains(refusal(scene, mode("64")), "take a mode of at most 8, or more scheme.cells"));
    const Keys one_each{{"ends.right", "fixed"}, {key, "5"}, {"scheme.particles_per_cell", "1"}};
    CHECK(codes_before(scene, one_each) == Codes{"coarse-mode"});
  }
}

TEST_CASE("fault 9: particles too far from the origin to be told apart are refused", "[faults]") {
  const std::string bar = R"(
end_time = 1.0
body = { length = 1.0, start = 0.0 }
material = { law = "neo-hookean", density = 1.0, youngs_modulus = 1.0 }
ends = { left = "free", right = "free" }
scheme = { name = "bspline", cells = 16, particles_per_cell = 4, step_fraction = 0.2 }
)";
  const std::string told = " m from the origin are not told apart well enough by positions of 16 digits";
  for (const std::string scheme : {"classical", "bspline", "high-order", "total-lagrangian"})
    for (const std::string start : {"1e14", "-1e14", "1e9", "1e300"})
      CHECK(contains(refusal(bar, {{"scheme.name", scheme}, {"body.start", start}}), told));
  // The distance is 1/64 m: 1e6 units in the last place of 7e7 m.
  CHECK(contains(refusal(bar, {{"body.start", "7.1e7"}}), "must stay within 70368744.177664 m"));
  CHECK(message_of<hompm::SceneError>([&] { scene_of(bar, {{"body.start", "7.0e7"}}); }).empty());
  CHECK(contains(refusal(bar, {{"grid.to", "1e8"}}), "--set grid.to=1e8: particles 0.015625 m apart"));
  CHECK(contains(refusal(bar, {{"grid.from", "-1e12"}}), told));
  CHECK(contains(refusal(bar + "initial.displacement = { shape = \"uniform\", amplitude = 1e12 }\n"), told));
  CHECK(contains(refusal(R"(
end_time = 1.0
material = { law = "neo-hookean", density = 1.0, youngs_modulus = 1.0 }
ends = { left = "free", right = "free" }
scheme = { name = "bspline", cells = 16, particles_per_cell = 4, step_fraction = 0.2 }
[[body]]
length = 1.0
[[body]]
length = 1.0
start = 1e10
)"),
                 ":8:1: particles "));
}

TEST_CASE("fault 10: the law linear tells of strains that are not small", "[faults]") {
  const auto column = [](const std::string& modulus) {
    return result_of(linear_bar + effect("gravity", "acceleration = -9.81"),
                     {{"material.youngs_modulus", modulus}, {"material.density", "7850"}});
  };
  const auto soft = column("210");  // GPa meant
  CHECK(codes(soft.warnings) == Codes{"large-strain"});
  CHECK(contains(soft.warnings.front().text, "strains of up to "));
  CHECK(column("210e9").warnings.empty());
  const hompm::Scene scene = scene_of(
      linear_bar + "initial.displacement = { shape = \"linear\", amplitude = 0.0, gradient = 0.2 }\n",
      {{"output.history", "1"}});
  const auto stepping = hompm::time_stepping(scene);
  const auto result = hompm::run(scene, stepping);
  CHECK(codes(result.warnings) == Codes{"large-strain"});
  const std::optional<hompm::ErrorReport> none;
  const hompm::RunReport report{scene, stepping, result, none, "x"};
  CHECK(contains(hompm::run_json(report), "\"warnings\": [\n    {\n      \"code\": \"large-strain\""));
  CHECK(contains(hompm::run_summary(report), "  warning   large-strain\n"));
  CHECK(result_of(linear_bar, {{"material.law", "rate"}}).warnings.empty());
}

TEST_CASE("fault 11: another scheme keeps what suits it of a file, and names what does not", "[faults]") {
  const std::string text = R"(
end_time = 1.0
body = { length = 1.0 }
material = { law = "rate", density = 1.0, youngs_modulus = 1.0 }
ends = { left = "fixed", right = "free" }
[scheme]
name = "bspline"
degree = 3
cells = 8
particles_per_cell = 4
margin_cells = 5
flip_fraction = 0.95
step_fraction = 0.2
)";
  const auto with = [&](const std::string& scheme) { return scene_of(text, {{"scheme.name", scheme}}); };
  for (const std::string scheme : {"bspline", "total-lagrangian"}) {
    const hompm::Scene kept = with(scheme);
    CHECK(kept.scheme.degree == 3);
    CHECK(kept.scheme.margin_cells == 5);
    CHECK(kept.scheme.choices.flip_fraction == 0.95);
    CHECK(kept.warnings.empty());
  }
  const hompm::Scene classical = with("classical");
  CHECK(classical.scheme.degree == 1);
  CHECK(classical.scheme.margin_cells == 5);
  CHECK(classical.scheme.choices.flip_fraction == 0.95);
  REQUIRE(codes(classical.warnings) == Codes{"dropped-key"});
  CHECK(classical.warnings[0].text ==
        "--set scheme.name=classical drops `scheme.degree` = 3 (scene.toml:8:1): `scheme.degree` must be 1, "
        "the "
        "only degree of the scheme classical, not 3");
  const hompm::Scene apic = with("apic");
  CHECK(apic.scheme.degree == 3);
  CHECK(apic.scheme.choices.flip_fraction == 1.0);
  CHECK(codes(apic.warnings) == Codes{"dropped-key"});
  CHECK(contains(apic.warnings[0].text, "drops `scheme.flip_fraction` = 0.95"));
  // A margin that is too small for the higher degree.
  const hompm::Scene narrow = scene_of(text, {{"scheme.name", "total-lagrangian"}, {"scheme.degree", "5"}});
  CHECK(codes(narrow.warnings) == Codes{"dropped-key"});
  CHECK(narrow.scheme.margin_cells == 7);
  // A scene written out in full: what its scheme is by itself goes with it.
  const hompm::Scene whole = hompm::parse_scene(hompm::scene_text(scene_of(text)), "whole.toml",
                                                {{"scheme.name", "high-order", "--scheme high-order"}});
  CHECK(whole.scheme.choices.quadrature == hompm::Quadrature::reconstructed_exact);
  CHECK(whole.scheme.degree == 3);
  CHECK(codes(whole.warnings) == Codes{"dropped-key"});
  // A name that is no scheme is told as such; so in a scene of several bodies.
  CHECK(contains(refusal(text, {{"scheme.name", "bsplin"}}), "did you mean \"bspline\"?"));
  const hompm::Scene two = scene_of(R"(
end_time = 1.0
material = { law = "rate", density = 1.0, youngs_modulus = 1.0 }
scheme = { name = "bspline", degree = 4, cells = 8, particles_per_cell = 4, step_fraction = 0.2 }
[[body]]
length = 1.0
[[body]]
length = 1.0
)",
                                    {{"scheme.name", "mls"}});
  CHECK(two.scheme.degree == 2);
  CHECK(codes(two.warnings) == Codes{"dropped-key"});
}

TEST_CASE("fault 13: a run is not stopped for energies far below those of its scene", "[faults]") {
  const std::string wall =
      linear_bar + effect("traction", "value = 0.01\nramp_time = 0.2") + effect("wall", "position = 1.0");
  for (const std::string scheme : {"cpdi", "bspline", "classical", "high-order"})
    for (const std::string modulus : {"1.0", "1e-12", "1e12"})
      CHECK(result_of(wall, {{"scheme.name", scheme},
                             {"scheme.cells", "32"},
                             {"material.youngs_modulus", modulus},
                             {"material.density", modulus},
                             {"effect.traction.value", modulus == "1.0" ? "0.01" : modulus}})
                .end.time == 1.0);
  // Rounding of a start displaced as a whole stores energy, of nothing else.
  const std::string moved = R"(
end_time = 1.0
body = { length = 1.0 }
material = { law = "rate", density = 1.0, youngs_modulus = 1.0 }
ends = { left = "free", right = "free" }
initial.displacement = { shape = "uniform", amplitude = 0.1 }
scheme = { name = "high-order", cells = 16, particles_per_cell = 4, step_fraction = 0.2 }
)";
  CHECK(result_of(moved).end.time == 1.0);
  // What grows is still stopped.
  CHECK(contains(
      message_of<hompm::InvalidRun>([&] {
        result_of(wall,
                  {{"scheme.step_fraction", "2.5"}, {"scheme.allow_unstable", "true"}, {"end_time", "100"}});
      }),
      "unstable: energy "));
}

TEST_CASE("fault 16: a shock is only told of where there is one", "[faults]") {
  const auto reason = [](const std::string& text, const Keys& keys) {
    const hompm::Scene scene = scene_of(text, keys);
    std::string why;
    const auto errors = hompm::judge(scene, hompm::run(scene, hompm::time_stepping(scene)), why);
    return errors ? std::string("judged") : why;
  };
  // A load that the reference does not resolve: the law is linear.
  const std::string pulled = linear_bar + effect("traction", "value = 0.01\nfrequency = 300.0");
  const std::string unresolved = reason(pulled, {{"scheme.time_step", "1e-4"}, {"end_time", "0.5"}});
  CHECK_FALSE(contains(unresolved, "shock"));
  // The bar is as long as at the start once in every period of 4 s.
  const std::string released =
      linear_bar + "initial.velocity = { shape = \"linear\", amplitude = 0.0, gradient = 1e-3 }\n";
  CHECK(reason(released, {{"end_time", "2.0"}}) == "judged");
  CHECK(reason(released, {{"end_time", "4.0"}}) == "judged");
}

TEST_CASE("fault 18: more particles are recommended only where they help", "[faults]") {
  const std::string meeting = R"(
end_time = 2.0
material = { law = "rate", density = 1.0, youngs_modulus = 1.0 }
ends = { left = "free", right = "free" }
scheme = { name = "tielen2017", cells = 32, particles_per_cell = 4, step_fraction = 0.2 }
[[body]]
length = 1.0
initial.velocity = { shape = "uniform", amplitude = 0.6 }
[[body]]
length = 1.0
start = 1.1
initial.velocity = { shape = "uniform", amplitude = -0.6 }
)" + effect("contact", "");
  const auto message = [](const std::string& text) {
    return message_of<hompm::InvalidRun>([&] { result_of(text); });
  };
  CHECK(contains(message(meeting), "the density spline is not positive"));
  CHECK(contains(message(meeting),
                 "a shock, which more of them make steeper; the effect bulk-viscosity spreads it, or "
                 "take scheme.name = \"high-order\""));
  CHECK(message(meeting + effect("bulk-viscosity", "")).empty());
}

TEST_CASE("names of cases and variants stay in the output folder", "[faults]") {
  for (const std::string key : {"case", "variant"})
    for (const std::string name : {"\"../../x\"", "\"/tmp/x\"", "\"a/b\"", "\"a\\u0007\""})
      CHECK(contains(refusal(linear_bar, {{key, name}}),
                     '`' + key + "` is part of the name of the output folder"));
  CHECK(refusal(linear_bar, {{"case", "\"..\""}, {"variant", "a b"}}).empty());
}

TEST_CASE("a key that is said twice on the command line is refused", "[faults]") {
  CHECK(refusal(linear_bar, {{"end_time", "1"}, {"end_time", "2"}}) ==
        "--set end_time=2: `end_time` is said twice, here and by --set end_time=1: give it once");
  const std::string pulled = linear_bar + effect("traction", "value = 0.01");
  CHECK(contains(refusal(pulled, {{"effect.traction.value", "1"}, {"effect[0].value", "2"}}),
                 "`effect[0].value` is said twice, here and by --set effect.traction.value=1"));
}

TEST_CASE("a number that is held as another is refused", "[faults]") {
  const auto start = [](const std::string& number) {
    return refusal(linear_bar + "[initial.velocity]\nshape = \"uniform\" # µ\namplitude = " + number + "\n");
  };
  for (const std::string number : {"-1e-400", "1e-400", "1e-320", "0.0000001e-320", "-5e-324"}) {
    CHECK(contains(start(number), "scene.toml:9:13: `initial.velocity.amplitude` is too small or too large"));
    CHECK(contains(refusal(linear_bar, {{"end_time", number}}), '"' + number + '"'));
  }
  for (const std::string number : {"1e400", "-1e309"}) CHECK_FALSE(start(number).empty());
  for (const std::string number : {"0.0", "-0.0", "0e-400", "2.3e-308", "1e-300"})
    CHECK(start(number).empty());
  CHECK(contains(start("inf"), "must be a finite number (m/s), not inf"));
  CHECK(contains(refusal("\"µ\" = { b = 1e-400 }\n"), "is too small or too large"));
}
