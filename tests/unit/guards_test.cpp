// What watches a run beside the stages: finite values, order, energy; and what it says.
#include <cmath>
#include <limits>
#include <string>

#include <hompm/error.hpp>
#include <hompm/simulation/guards.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/scenes.hpp"

namespace {

using hompm::InvalidRun;
using hompm::Simulation;
using hompm::detail::Guards;
using hompm::test::built_in;
using hompm::test::contains;
using hompm::test::free_body;
using hompm::test::message_of;

/// A body in flight of kinetic energy ½, after 128 steps as far as the guards can tell.
struct Flight {
  explicit Flight(const char* scheme = "classical") : simulation(free_body({{"scheme.name", scheme}}), 1e-3) {
    for (double& v : particles().velocity) v = 1.0;
    row = simulation.history(0.0);
    simulation.state().step = 128;
    simulation.state().time = 0.128;
  }
  hompm::Particles& particles() { return simulation.state().particles; }
  std::string message() {
    return message_of<InvalidRun>([&] { Guards(row, 0.0, 0.0).look(simulation); });
  }
  Simulation simulation;
  hompm::HistoryRow row;
};

}  // namespace

TEST_CASE("a velocity, a stress or a position that is not finite is told with its particle, step and time") {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
    Flight velocity, stress, position, last;
    velocity.particles().velocity[7] = bad;
    CHECK_THAT(velocity.message(), contains("invalid at step 128, t = 0.128 s, particle 7: velocity is not"));
    stress.particles().stress[5] = bad;
    CHECK_THAT(stress.message(), contains("particle 5: stress is not a finite number"));
    position.particles().position[3] = bad;
    CHECK_THAT(position.message(), contains("particle 3: position is not a finite number"));
    last.particles().position.back() = bad;
    CHECK_THAT(last.message(), contains("position is not a finite number"));
  }
}

TEST_CASE("particles out of order are found in schemes that would not notice") {
  Flight flight("bspline");
  std::swap(flight.particles().position[10], flight.particles().position[11]);
  CHECK_THAT(flight.message(), contains("particle 11: passed its left neighbour"));
}

TEST_CASE("energy may grow to ten times what the start and the loads supplied, and not beyond") {
  Flight flight;
  for (double& v : flight.particles().velocity) v = 3.1;  // 9.6 times the energy
  Guards(flight.row, 0.0, 0.0).look(flight.simulation);
  for (double& v : flight.particles().velocity) v = 3.2;  // 10.2 times
  CHECK_THAT(flight.message(), contains("unstable: energy 5.12") && contains("supplied 0.5"));
  Guards(flight.row, 0.1, 0.0).look(flight.simulation);  // the loads supplied some
  Guards(flight.row, 0.0, 0.6).look(flight.simulation);  // the loads may yet supply some
  flight.simulation.state().balance.external_work = 0.1;
  Guards(flight.row, 0.0, 0.0).look(flight.simulation);
  flight.simulation.state().balance.external_work = 0.0;
  flight.simulation.state().step = 127;
  Guards(flight.row, 0.0, 0.0).look(flight.simulation);  // not one that is looked at
  CHECK_THROWS_AS(Guards(flight.row, 0.0, 0.0).check(flight.simulation, flight.simulation.history(0.0)),
                  InvalidRun);  // unless it is reported
}

TEST_CASE("a run that its step drives mad says so long before the next output") {
  const auto scheme = GENERATE(as<std::string>{}, "bspline", "high-order");
  const hompm::Scene scene = built_in("bar", "small",
                                      {{"scheme.name", scheme},
                                       {"scheme.cells", "16"},
                                       {"scheme.step_fraction", "1.1"},
                                       {"scheme.allow_unstable", "true"},
                                       {"material.law", "linear"},
                                       {"kinematics", "infinitesimal"},
                                       {"output.history", "1"},
                                       {"output.snapshots", "1"},
                                       {"end_time", "10000"}});
  hompm::RunObserver observer;
  int reported = 0;
  observer.snapshot = [&](const hompm::Snapshot&) { ++reported; };
  observer.history = [&](const hompm::HistoryRow&) { ++reported; };
  std::int64_t step = 0;
  observer.progress = [&](std::int64_t now, std::int64_t) { step = now; };
  const auto message =
      message_of<InvalidRun>([&] { hompm::run(scene, hompm::time_stepping(scene), observer); });
  INFO(message);
  CHECK(reported == 2);  // the start
  CHECK(step < 1000);
  CHECK_THAT(message, contains("unstable: energy ") && contains("here the time step is too large, 1.09"));
}
