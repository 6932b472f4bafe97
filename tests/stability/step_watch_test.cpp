// The critical step as the configuration changes: what a run reports, and what it says when the step was too
// large.
#include <algorithm>
#include <optional>
#include <string>

#include <hompm/error.hpp>
#include <hompm/kit/output/run_report.hpp>
#include <hompm/simulation/critical_step.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/scenes.hpp"

namespace {

using hompm::Scene;
using hompm::test::contains;

Scene bar(const std::string& law, const std::string& cells, const std::string& fraction) {
  return hompm::test::built_in("bar", "large",
                               {{"scheme.name", "bspline"},
                                {"material.law", law},
                                {"scheme.cells", cells},
                                {"scheme.step_fraction", fraction},
                                {"end_time", "1.5"}});
}

std::string summary_of(const Scene& scene, const hompm::RunResult& result) {
  const std::optional<hompm::ErrorReport> errors;
  return hompm::run_summary({scene, hompm::time_stepping(scene), result, errors, "not asked for"});
}

}  // namespace

TEST_CASE("a run reports the largest part of the critical step that it met") {
  // Waves in compressed hencky are faster in space; those of rate keep their speed (docs/method.md).
  const std::string law = GENERATE("hencky", "rate");
  const Scene scene = bar(law, "256", "0.95");
  const auto stepping = hompm::time_stepping(scene);
  double largest = 0.0;
  hompm::CriticalStep critical(scene);
  hompm::Simulation simulation(scene, stepping.time_step);
  for (int step = 1; step <= stepping.steps; ++step) {
    simulation.step();
    if (step % 16 == 0) largest = std::max(largest, stepping.time_step / critical.at(simulation.state()));
  }
  const auto result = hompm::run(scene, stepping);
  INFO(law << ": " << result.largest_step_fraction << ", by all steps " << largest);
  // Looked at every 64 steps, where waves have become faster by 2 %; particles that cross cells change the
  // limit by some per cent in between. The start counts, too.
  CHECK(result.largest_step_fraction > 0.92 * largest);
  CHECK(result.largest_step_fraction <
        1.01 * std::max(largest, stepping.time_step / stepping.critical_time_step));
  CHECK((result.largest_step_fraction > 1.0) == (law == "hencky"));
  const bool told = contains(" of it for a while").match(summary_of(scene, result));
  CHECK(told == (law == "hencky"));
}

TEST_CASE("a run that ends because its step became too large says so, and by how much") {
  const Scene scene = bar("hencky", "512", "0.98");
  CHECK(hompm::time_stepping(scene).time_step < hompm::time_stepping(scene).critical_time_step);
  const auto message =
      hompm::test::message_of<hompm::InvalidRun>([&] { hompm::run(scene, hompm::time_stepping(scene)); });
  CHECK_THAT(message, contains("invalid at step ") && contains("here the time step is too large, 1.0") &&
                          contains(" of the critical one"));
}
