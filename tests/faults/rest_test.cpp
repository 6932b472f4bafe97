// Fault 14 of the list: a settled column of high-order, p = 2, that local damping keeps moving, and a summary
// that did not say why there was no rest.
#include <optional>
#include <string>

#include <hompm/output/run_report.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace {

using hompm::test::built_in;
using hompm::test::contains;

hompm::Scene settled(const std::string& scheme, const std::string& degree, const std::string& end_time) {
  return built_in("column", "settled",
                  {{"scheme.name", scheme},
                   {"scheme.degree", degree},
                   {"scheme.cells", "8"},
                   {"scheme.time_step", "1e-3"},
                   {"end_time", end_time}});
}

std::string summary(const hompm::Scene& scene, const hompm::RunResult& result) {
  const hompm::TimeStepping stepping{.time_step = 1e-3, .steps = 3, .critical_time_step = 1.0};
  const std::optional<hompm::ErrorReport> errors;
  return hompm::run_summary({scene, stepping, result, errors, "not asked for"});
}

}  // namespace

TEST_CASE(
    "a column that settles comes to rest with every scheme, or the summary says what keeps it from that") {
  for (const std::string scheme : {"classical", "bspline", "tielen2017", "mls", "tls", "high-order"})
    for (const std::string degree : {"1", "2", "3"}) {
      if ((degree == "1") == (scheme == "high-order" || scheme == "bspline")) continue;
      if (degree == "3" && scheme == "classical") continue;
      if (degree != "1" && scheme == "classical") continue;
      const hompm::Scene scene = settled(scheme, degree, "15");
      const hompm::RunResult result = hompm::run(scene, hompm::time_stepping(scene));
      INFO(scheme << degree);
      if (result.at_rest) {
        CHECK(result.last_speed <= scene.rest->speed);
        CHECK_THAT(summary(scene, result), contains("rest      reached\n"));
        continue;
      }
      // The function that the extension ties bears a force at rest, of which the damping takes its part.
      CHECK((scheme == "high-order" && degree == "2"));
      CHECK(result.to_and_fro);
      CHECK(result.last_speed < 1e-4);  // 2e-5 measured
      CHECK_THAT(summary(scene, result), contains("m/s in the last step, rest.speed is 1e-06 m/s;") &&
                                             contains("local damping keeps up: raise rest.speed"));
    }
}

TEST_CASE("a run that ends too early for rest says how fast it still is") {
  const hompm::Scene scene = settled("bspline", "2", "0.5");
  hompm::RunResult result = hompm::run(scene, hompm::time_stepping(scene));
  CHECK(!result.at_rest);
  CHECK(result.last_speed > 0.1);
  CHECK_THAT(summary(scene, result), contains("rest.speed is 1e-06 m/s\n"));
  result.last_speed = 1e-7;
  CHECK_THAT(summary(scene, result), contains("but not for the time of a wave there and back\n"));
}
