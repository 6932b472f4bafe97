// What the summary says of the time step.
#include <optional>
#include <string>

#include <hompm/kit/output/run_report.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace {

using hompm::test::contains;

/// Of a run that met `met` of the critical step, with a step of 1 s where the first limit is `critical`.
std::string summary(double met, double critical) {
  const hompm::Scene scene = hompm::test::built_in("bar", "small", {});
  const hompm::TimeStepping stepping{.time_step = 1.0, .steps = 3, .critical_time_step = critical};
  hompm::RunResult result;
  result.largest_step_fraction = met;
  const std::optional<hompm::ErrorReport> errors;
  return hompm::run_summary({scene, stepping, result, errors, "not asked for"});
}

}  // namespace

TEST_CASE("the summary tells when the step became larger than the critical one, and by how much") {
  CHECK_THAT(summary(1.25, 2.0), contains("critical step is 2 s, and the step was 1.25 of it for a while\n"));
  CHECK_THAT(summary(0.75, 2.0), contains("critical step is 2 s\n"));
  CHECK_THAT(summary(1.25, 0.8), contains("critical step is 0.8 s\n"));  // it was too large from the start
}
