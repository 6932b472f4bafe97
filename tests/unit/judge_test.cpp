// When a run is not judged it says why, and a run whose energy grows is stopped.
#include <string>

#include <hompm/error.hpp>
#include <hompm/kit/verify/judge.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

using hompm::test::built_in;
using hompm::test::contains;

namespace {

/// Why the scene, run to its end, is not judged; "" when it is.
std::string reason_of(const hompm::Scene& scene) {
  std::string reason;
  const auto errors = hompm::judge(scene, hompm::run(scene, hompm::time_stepping(scene)), reason);
  CHECK(errors.has_value() == reason.empty());
  return reason;
}

}  // namespace

TEST_CASE("a run is judged by the reference of its scene, and says why when it is not") {
  CHECK(reason_of(built_in("bar", "large", {{"scheme.cells", "8"}, {"end_time", "0.1"}})).empty());
  CHECK_THAT(reason_of(built_in("column", "settled", {{"scheme.cells", "8"}, {"end_time", "0.1"}})),
             contains("not come to rest"));
  auto damped = built_in("column", "settled", {{"scheme.cells", "8"}, {"end_time", "0.1"}});
  damped.rest.reset();
  CHECK_THAT(reason_of(damped), contains("no reference solution is known"));
  // v0 = 0.5 c steepens to a shock within a period: the method of lines says by its own error that it is lost
  CHECK_THAT(reason_of(built_in("bar", "large",
                                {{"scheme.cells", "8"},
                                 {"end_time", "5"},
                                 {"scheme.name", "bspline"},
                                 {"initial.velocity.amplitude", "5"},
                                 {"scheme.step_fraction", "0.2"}})),
             contains("shock") || contains("no smooth"));
}

TEST_CASE("energy beyond what the start and the loads supplied ends the run as unstable") {
  // A bar of small amplitude: linear, so nothing inverts or leaves before the energy has grown.
  const auto scene = built_in("bar", "small",
                              {{"material.law", "linear"},
                               {"scheme.name", "bspline"},
                               {"scheme.step_fraction", "1.02"},
                               {"scheme.allow_unstable", "true"},
                               {"end_time", "60"}});
  CHECK_THROWS_AS(hompm::run(scene, hompm::time_stepping(scene)), hompm::InvalidRun);
  CHECK_THROWS_WITH(hompm::run(scene, hompm::time_stepping(scene)),
                    contains("unstable: energy") && contains("of the critical one"));
}

TEST_CASE("particles that do not determine a velocity on the grid are refused before the first step") {
  const auto scene =
      built_in("bar", "large", {{"scheme.name", "high-order"}, {"scheme.particles_per_cell", "1"}});
  CHECK_THROWS_AS(hompm::time_stepping(scene), hompm::SceneError);
  CHECK_THROWS_WITH(hompm::time_stepping(scene),
                    contains("cannot be started") && contains("raise scheme.particles_per_cell"));
}

TEST_CASE("what a plan cannot be made of is refused") {
  auto scene = built_in("column", "large");
  scene.effects.front().type = "gravty";
  CHECK_THROWS_AS(hompm::run(scene, hompm::TimeStepping{1e-4, 1, 1.0}), hompm::SceneError);
  CHECK_THROWS_AS(hompm::find_scheme("tielen2071"), hompm::Error);
  CHECK_THROWS_WITH(hompm::time_stepping(built_in("bar", "large", {{"scheme.time_step", "1e-12"}})),
                    contains("more than 1e10 steps"));
  CHECK_THROWS_WITH(built_in("bar", "large", {{"scheme.relaxation_rate", "1"}}),
                    contains("`scheme.stress_update` must be \"from-positions\""));
}

TEST_CASE("a reference that cannot go as far as the run is the reason not to judge") {
  const auto scene = built_in("bar", "large", {{"initial.velocity.amplitude", "5"}});
  hompm::RunResult result;
  result.final.time = 20.0;  // the reference turns inside out before
  result.final.reference_position = {1.0, 2.0};
  std::string reason;
  CHECK_FALSE(hompm::judge(scene, result, reason).has_value());
  CHECK_THAT(reason, contains("no smooth"));
}
