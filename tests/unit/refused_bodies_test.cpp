// Walls, neighbours and grids that do not fit the bodies: each is told before the run.
#include <string>

#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/scenes.hpp"

namespace {

using hompm::SceneError;
using hompm::test::contains;

std::string refusal(const std::string& text) {
  return hompm::test::message_of<SceneError>(
      [&] { hompm::Simulation(hompm::parse_scene(text, "bodies test", {}), 1e-3); });
}

const std::string common = R"(
end_time = 1
scheme = { name = "bspline", particles_per_cell = 2, time_step = 1e-3 }
)";

std::string body(const std::string& start) {
  return R"([[body]]
start = )" +
         start + R"(
length = 1
cells = 8
material = { law = "rate", density = 1, youngs_modulus = 1 }
ends = { left = "free", right = "free" }
)";
}

std::string pair(const std::string& second_start, const std::string& effect) {
  return common + body("0") + body(second_start) + "[[effect]]\ntype = \"" + effect + "\"\n";
}

std::string walled(const std::string& position) {
  return R"(
end_time = 1
body = { start = 0, length = 1 }
material = { law = "rate", density = 1, youngs_modulus = 1 }
ends = { left = "free", right = "free" }
scheme = { name = "bspline", cells = 8, particles_per_cell = 2, time_step = 1e-3 }
effect = [ { type = "wall", end = "right", position = )" +
         position + " } ]\n";
}

}  // namespace

TEST_CASE("a wall inside the body or off the grid is refused") {
  CHECK(contains(refusal(walled("0.5")), "the wall at 0.5 m is inside the body, whose end is at 1 m"));
  CHECK(contains(refusal(walled("50")), "the wall at 50 m is off the grid"));
  CHECK(refusal(walled("1.1")).empty());
}

TEST_CASE("bodies that overlap, or do not touch where they are bonded, are refused") {
  CHECK(contains(refusal(pair("0.75", "contact")), "the bodies 0 and 1 overlap by 0.25 m"));
  CHECK(contains(refusal(pair("1.5", "interface")),
                 "the bodies 0 and 1 must touch where they are bonded; between them are 0.5 m"));
  CHECK(refusal(pair("1.5", "contact")).empty());
  CHECK(refusal(pair("1", "interface")).empty());
}

TEST_CASE("a list of bodies that is empty, and a body that is not there, are refused") {
  CHECK(contains(refusal("body = []\n" + common), "[[body]] tables, not 0"));
  CHECK(contains(
      hompm::test::message_of<SceneError>([] {
        hompm::parse_scene(pair("1.5", "contact"), "bodies test", {{"body[5].length", "2", "--set"}});
      }),
      "the scene has no body[5]; it has 2 bodies, from body[0]"));
}

TEST_CASE("a grid of too many cells is refused") {
  CHECK(contains(refusal(R"(
end_time = 1
body = { start = 0, length = 1 }
material = { law = "rate", density = 1, youngs_modulus = 1 }
ends = { left = "free", right = "free" }
grid = { to = 1e9 }
scheme = { name = "bspline", cells = 8, particles_per_cell = 2, time_step = 1e-3 }
)"),
                 "the grid must have at most 1e8 cells"));
}

TEST_CASE("a step that no critical step allows is refused before the run") {
  const auto scene = hompm::parse_scene(R"(
end_time = 1
body = { length = 1 }
material = { law = "rate", density = 1, youngs_modulus = 1 }
scheme = { name = "tielen2017", degree = 3, cells = 8, particles_per_cell = 1, step_fraction = 0.5 }
)",
                                        "bodies test", {});
  CHECK(contains(hompm::test::message_of<SceneError>([&] { hompm::time_stepping(scene); }),
                 "no step is stable"));
}
