// Fault 14 of the list: a settled column of high-order, p = 2, that local damping kept moving, and a summary
// that did not say why there was no rest.
#include <optional>
#include <string>

#include <hompm/kit/output/run_report.hpp>

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
                   {"scheme.time_step", "5e-4"},
                   {"end_time", end_time}});
}

std::string summary(const hompm::Scene& scene, const hompm::RunResult& result) {
  const hompm::TimeStepping stepping{.time_step = 5e-4, .steps = 3, .critical_time_step = 1.0};
  const std::optional<hompm::ErrorReport> errors;
  return hompm::run_summary({scene, stepping, result, errors, "not asked for"});
}

}  // namespace

TEST_CASE("a column that settles comes to rest, or the summary says what keeps it from that") {
  for (const std::string scheme : {"bspline", "tielen2017", "tls", "high-order"})
    for (const std::string degree : {"2", "3"}) {
      const hompm::Scene scene = settled(scheme, degree, "15");
      const hompm::RunResult result = hompm::run(scene, hompm::time_stepping(scene));
      const std::string said = summary(scene, result);
      INFO(scheme << degree << ": " << result.last_speed);
      const auto says = [&](const char* part) { return said.find(part) != std::string::npos; };
      CHECK(result.at_rest == says("rest      reached\n"));
      CHECK(result.at_rest != says(" m/s in the last step, rest.speed is 1e-06 m/s"));
      CHECK(result.at_rest == (result.last_speed <= scene.rest->speed));
      if (scheme == "high-order") CHECK(result.at_rest);
    }
}

TEST_CASE("high-order comes to rest with local damping, whatever grid and degree, at either end") {
  // The force at rest on the function that the extension ties is no force out of balance. A quarter of the
  // critical step, as docs/stability.md says.
  for (const int degree : {2, 3, 4, 5})
    for (const int cells : {12, 17})
      for (const bool upside_down : {false, true}) {
        const hompm::Scene scene = built_in("column", "settled",
                                            {{"scheme.name", "high-order"},
                                             {"scheme.degree", std::to_string(degree)},
                                             {"scheme.cells", std::to_string(cells)},
                                             {"scheme.step_fraction", "0.25"},
                                             {"scheme.margin_cells", std::to_string(cells / 2)},
                                             {"ends.left", upside_down ? "free" : "fixed"},
                                             {"ends.right", upside_down ? "fixed" : "free"},
                                             {"effect.gravity.acceleration", upside_down ? "9.81" : "-9.81"},
                                             {"rest.speed", "1e-9"}});
        const hompm::RunResult result = hompm::run(scene, hompm::time_stepping(scene));
        CAPTURE(degree, cells, upside_down, result.last_speed);
        CHECK(result.at_rest);
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
