// Several bodies against closed forms: collisions, interfaces of materials, and bodies that never meet.
#include <cmath>
#include <string>
#include <vector>

#include <hompm/kit/recorder/checkpoint.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace {

hompm::Scene example(const std::string& name, std::vector<hompm::Override> more = {}) {
  return hompm::load_scene(HOMPM_SOURCE_DIR "/docs/scenes/" + name + ".toml", more);
}

hompm::RunResult run(const hompm::Scene& scene) { return hompm::run(scene, hompm::time_stepping(scene)); }

std::vector<hompm::Override> scheme(const std::string& name, const std::string& cells = "32") {
  return {{"scheme.name", name, "--scheme"}, {"scheme.cells", cells, "--cells"}};
}

double momentum(const hompm::Snapshot& snapshot, std::int64_t body) {
  double sum = 0.0;
  for (std::size_t i = 0; i < snapshot.size(); ++i)
    if (snapshot.body[i] == body) sum += snapshot.density[i] * snapshot.volume[i] * snapshot.velocity[i];
  return sum;
}

}  // namespace

TEST_CASE("equal bars that collide exchange their velocities") {
  const std::string name = GENERATE(as<std::string>{}, "classical", "bspline", "tielen2017", "high-order");
  INFO(name);
  const auto left_behind = [&](const std::string& cells) {
    const auto result = run(example("contact", scheme(name, cells)));
    // Impulses on the two are opposite: what one gives the other takes, but for the O(h²) of high-order's
    // density.
    CHECK(std::abs(result.end.momentum_residual) < 1e-4 * result.start.momentum);
    CHECK(std::abs(result.end.residual) < 0.02 * result.start.kinetic);
    CHECK(result.end.dissipated >= 0.0);
    return std::abs(momentum(result.final, 0) / result.start.momentum);
  };
  // Half of what a rebound from a wall loses, and of its order: q/(q + 1), with waves of order 2, and 6 of
  // high-order in space (docs/method.md, Jumps).
  const double limit = name == "high-order" ? 6.0 / 7.0 : 2.0 / 3.0;
  const double coarse = left_behind("16");
  const double fine = left_behind("64");
  CHECK(fine < (name == "high-order" ? 0.15 : 0.35) * std::pow(64.0, -limit));
  const double order = std::log2(coarse / fine) / 2.0;
  CAPTURE(order);
  CHECK(order > limit - 0.05);
  CHECK(order < 1.0);
}

TEST_CASE("unequal bars part after the wave has run through the shorter one and back") {
  // Both of Z = 1; the one of length 1/2 hits the one of length 1 with 0.1 m/s. A wave of v/2 enters both;
  // from the free end of the shorter one it comes back after 1 s and takes it to rest: all its momentum is in
  // the longer one.
  const auto result = run(example("contact", {{"body[0].length", "0.5", "--set"},
                                              {"body[0].start", "0.5", "--set"},
                                              {"body[0].cells", "32", "--set"},
                                              {"body[1].cells", "64", "--set"}}));
  CHECK(std::abs(momentum(result.final, 0)) < 0.02 * 0.05);
  CHECK(std::abs(momentum(result.final, 1) - 0.05) < 0.02 * 0.05);
}

TEST_CASE("an interface of two materials reflects and transmits by their impedances") {
  // Young's moduli 1 and M: impedances 1 and √M, of the velocity of the pulse (1 − √M)/(1 + √M) comes back;
  // its momentum is 0.02. The second bar is longer by its wave speed, so that the pulse stays in it.
  struct Case {
    std::string modulus, length;
    double impedance, bound;
  };
  const auto& c =
      GENERATE(values<Case>({{"4", "2", 2.0, 1e-4}, {"0.25", "1", 0.5, 1e-3}, {"1e6", "1000", 1e3, 1e-4}}));
  INFO(c.modulus);
  const auto result =
      run(example("interface", {{"body[1].material.youngs_modulus", c.modulus, "--set"},
                                {"body[1].length", c.length, "--set"},
                                {"body[1].cells", c.modulus == "1e6" ? "80" : "64", "--set"}}));
  const double reflected = (1.0 - c.impedance) / (1.0 + c.impedance);
  CHECK(std::abs(momentum(result.final, 0) / 0.02 - reflected) < c.bound);
  CHECK(std::abs(momentum(result.final, 1) / 0.02 - (1.0 - reflected)) < c.bound);
  // Second order in the step; and the pulse is shortest, 6 cells of half its length, behind the softer bar.
  CHECK(std::abs(result.end.residual) < 1e-3 * result.end.external_work);
}

TEST_CASE("one body cut in two and bonded moves as the whole") {
  // The grids end at the cut, and each end is a free one: the fields differ by the error of the scheme.
  const std::string common = R"(
end_time = 1.0
material = { law = "neo-hookean", density = 1, youngs_modulus = 1 }
ends.left = "free"
ends.right = "free"
effect = [ { type = "piston", velocity = 0.1, ramp_time = 0.5, end = "left")";
  const std::string grid = R"(
scheme = { name = "high-order", degree = 3, cells = 16, particles_per_cell = 4, time_step = 2e-3 }
)";
  const auto whole = run(hompm::parse_scene(common + " } ]" + grid + "body.length = 1\n", "whole", {}));
  const auto halves = run(hompm::parse_scene(
      common + ", body = 0 }, { type = \"interface\" } ]" + grid +
          "[[body]]\nlength = 0.5\ncells = 8\n[[body]]\nstart = 0.5\nlength = 0.5\ncells = 8\n",
      "halves", {}));
  REQUIRE(halves.final.size() == whole.final.size());
  for (std::size_t i = 0; i < whole.final.size(); ++i) {
    CHECK(halves.final.reference_position[i] == whole.final.reference_position[i]);
    CHECK(std::abs(halves.final.velocity[i] - whole.final.velocity[i]) < 2e-3 * 0.1 * 5.0);
  }
}

TEST_CASE("bodies that nothing couples run as each by itself, bit for bit") {
  const std::string shared = R"(
end_time = 0.5
material = { law = "rate", density = 1, youngs_modulus = 1 }
ends = { left = "fixed", right = "fixed" }
initial.velocity = { shape = "sine", amplitude = 0.1 }
scheme = { name = "tielen2017", cells = 16, particles_per_cell = 4, time_step = 2e-3 }
)";
  const auto one = run(hompm::parse_scene(shared + "body.length = 1\n", "one", {}));
  const auto two =
      run(hompm::parse_scene(shared + "[[body]]\nlength = 2\n[[body]]\nlength = 1\n[[body]]\nlength = "
                                      "3\ninitial.velocity.amplitude = 0.2\n",
                             "two", {}));
  CHECK(two.final.size() == 3 * one.final.size());
  for (std::size_t i = 0; i < one.final.size(); ++i) {
    CHECK(two.final.body[i + one.final.size()] == 1);
    CHECK(two.final.displacement[i + one.final.size()] == one.final.displacement[i]);
    CHECK(two.final.stress[i + one.final.size()] == one.final.stress[i]);
  }
}

TEST_CASE("a run of several bodies goes on from a point as if it had never stopped") {
  const auto scene =
      example("interface", {{"scheme.cells", "8", "--cells"}, {"body[0].cells", "8", "--set"}});
  const auto stepping = hompm::time_stepping(scene);
  std::vector<hompm::RunPoint> points;
  const auto whole = hompm::run(scene, stepping,
                                {.snapshot = {},
                                 .history = {},
                                 .progress = {},
                                 .checkpoint = [&](const auto& point) { points.push_back(point); },
                                 .checkpoint_every = stepping.steps / 2});
  REQUIRE(!points.empty());
  auto checkpoint = hompm::first_checkpoint(scene);
  checkpoint.snapshots = {whole.final};
  checkpoint.point = points.front();
  const auto read = hompm::parse_checkpoint(hompm::checkpoint_bytes(checkpoint), "test");
  CHECK(read.snapshots.front().body == whole.final.body);
  const auto rest = hompm::run(scene, stepping, {}, &read.point);
  CHECK(rest.final.velocity == whole.final.velocity);
  CHECK(rest.final.body == whole.final.body);
  CHECK(rest.end.residual == whole.end.residual);
}

TEST_CASE("a scene of several bodies is written and read back the same") {
  const auto scene = example("interface");
  const std::string text = hompm::scene_text(scene);
  CHECK(hompm::scene_text(hompm::parse_scene(text, "again", {})) == text);
  REQUIRE(scene.bodies.size() == 2);
  CHECK(scene.bodies[1].material.youngs_modulus == 4.0);
  REQUIRE(scene.bodies[0].effects.size() == 2);  // the piston, and what couples it
  CHECK(scene.bodies[0].effects[0].type == "piston");
  REQUIRE(scene.bodies[1].effects.size() == 1);
  CHECK(scene.bodies[1].effects[0].type == "interface");
}
