// Properties of the steps of every scheme: what must hold to rounding whatever the numbers are.
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include <hompm/error.hpp>
#include <hompm/scheme/scheme.hpp>
#include <hompm/simulation/run.hpp>
#include <hompm/simulation/simulation.hpp>

#include "support/catch.hpp"
#include "support/recorded_run.hpp"
#include "support/scenes.hpp"

using hompm::Phase;
using hompm::Simulation;
using hompm::test::built_in;
using hompm::test::free_body;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

void move_to(Simulation& simulation, const std::vector<double>& positions) {
  auto& p = simulation.state().particles;
  p.reference_position = positions;
  p.position = positions;
}

/// Positions in [0, 1], each off its even place by up to a third of a spacing, without pattern.
std::vector<double> uneven(std::size_t count) {
  std::vector<double> x(count);
  std::uint32_t seed = 7;
  for (std::size_t i = 0; i < count; ++i) {
    seed = 1664525u * seed + 1013904223u;
    const double shift = (static_cast<double>(seed >> 16) / 65536.0 - 0.5) * 2.0 / 3.0;
    x[i] = (static_cast<double>(i) + 0.5 + shift) / static_cast<double>(count);
  }
  return x;
}

}  // namespace

TEST_CASE("the mass on the grid is the mass of the particles, for every scheme and degree") {
  const auto& scheme = GENERATE(from_range(hompm::scheme_table()));
  for (int degree = scheme.lowest_degree; degree <= scheme.highest_degree; ++degree) {
    Simulation simulation(
        built_in("bar", "large", {{"scheme.name", scheme.name}, {"scheme.degree", std::to_string(degree)}}),
        1e-4);
    const auto& mass = simulation.state().fields.mass;
    const double sum = std::accumulate(mass.begin(), mass.end(), 0.0);
    CHECK(std::abs(sum - simulation.state().total_mass) <= 256 * epsilon * sum);  // one rounding per particle
  }
}

TEST_CASE("rigid flight over 50 cells is exact to rounding, for every scheme and degree") {
  const auto& scheme = GENERATE(from_range(hompm::scheme_table()));
  for (int degree = scheme.lowest_degree; degree <= scheme.highest_degree; ++degree) {
    const auto scene = free_body({{"scheme.name", scheme.name},
                                  {"scheme.degree", std::to_string(degree)},
                                  {"scheme.margin_cells", "60"}});
    Simulation simulation(
        scene, 0.001);  // 0.04 cells a step: many cut spans, some filled before a particle is there
    auto& p = simulation.state().particles;
    std::fill(p.velocity.begin(), p.velocity.end(), 2.5);
    const int steps = 1250;  // 50 cells of 1/16 m
    for (int step = 0; step < steps; ++step) simulation.step();
    for (std::size_t i = 0; i < p.size(); ++i) {
      // A cut span of fraction ε amplifies the rounding of its own coefficient, and its basis value takes
      // that back, but for what the first function, (1 - s)^p/p! in the first cell, loses with p = 5.
      CHECK(std::abs(p.displacement[i] - 3.125) <= 1e-12);
      CHECK(std::abs(p.velocity[i] - 2.5) <= (degree < 5 ? 1e-12 : 2e-12));
      CHECK(std::abs(p.stretch[i] - 1.0) <= 1e-11);
    }
  }
}

TEST_CASE(
    "a uniform strain rate is exact to rounding with reconstruction, particles uneven, both ends free") {
  const int degree = GENERATE(1, 2, 3, 4, 5);
  Simulation simulation(free_body({{"scheme.degree", std::to_string(degree)}}), 1e-3);
  auto& p = simulation.state().particles;
  move_to(simulation, uneven(p.size()));
  for (std::size_t i = 0; i < p.size(); ++i) p.velocity[i] = 0.5 - 2.0 * p.position[i];
  simulation.plan().run(Phase::geometry, simulation.state());
  simulation.step();
  for (std::size_t i = 0; i < p.size(); ++i)
    CHECK(std::abs(p.stretch[i] - (1.0 - 2e-3)) <=
          1e-13);  // the condition of the mass matrix at degree 5 is 1e4
}

TEST_CASE("a constant stress gives no force inside with reconstruction, and some with particle quadrature") {
  const int degree = GENERATE(2, 3);
  const auto largest_inner_force = [&](const char* scheme) {
    Simulation simulation(free_body({{"scheme.name", scheme}, {"scheme.degree", std::to_string(degree)}}),
                          1e-3);
    auto& p = simulation.state().particles;
    move_to(simulation, uneven(p.size()));
    std::fill(p.stress.begin(), p.stress.end(), 7.0);
    simulation.plan().run(Phase::geometry, simulation.state());
    simulation.plan().run(Phase::total_stress, simulation.state());
    simulation.plan().run(Phase::internal_force, simulation.state());
    const auto& f = simulation.state().fields.internal_force;
    double largest = 0.0;
    const auto inside = static_cast<std::size_t>(6 + 2 * degree);  // the margin is 6 cells
    for (std::size_t i = inside; i + inside < f.size(); ++i) largest = std::max(largest, std::abs(f[i]));
    return largest;
  };
  CHECK(largest_inner_force("tielen2017") <=
        7.0 * 32 * epsilon * 16);  // stress × rounding of gradients of 1/h = 16
  CHECK(largest_inner_force("bspline") > 1e-3);
}

TEST_CASE("internal forces sum to zero, and momentum changes by the impulse alone") {
  const auto& scheme = GENERATE(from_range(hompm::scheme_table()));
  const auto scene =
      built_in("bar", "large", {{"scheme.name", scheme.name}, {"scheme.cells", "32"}, {"end_time", "0.5"}});
  const auto result = hompm::run(scene, hompm::time_stepping(scene));
  CHECK(result.largest_internal_force_sum <= 16 * epsilon);
  // Lumped: to the rounding of 5000 steps. The consistent mass is that of the density spline, not of the
  // particles: their momenta differ by its interpolation and quadrature error, which falls with the grid
  // (docs/method.md).
  const bool lumped = scheme.choices.acceleration_mass == hompm::MassForm::lumped;
  CHECK(result.largest_momentum_residual <= (lumped ? 1e-12 : 1e-4) * result.largest_momentum);
  CHECK(result.end.mass == result.start.mass);
}

TEST_CASE("a motion that is its own mirror image stays so") {
  const auto& scheme = GENERATE(from_range(hompm::scheme_table()));
  const auto scene = built_in("bar", "large",
                              {{"scheme.name", scheme.name},
                               {"scheme.cells", "16"},
                               {"end_time", "0.2"},
                               {"initial.velocity.mode", "2"}});
  const auto final = hompm::run(scene, hompm::time_stepping(scene)).final;
  for (std::size_t i = 0; i < final.size(); ++i) {
    const std::size_t mirror = final.size() - 1 - i;
    CHECK(std::abs(final.displacement[i] + final.displacement[mirror]) <=
          1e-12);  // sums run left to right: rounding differs
    CHECK(std::abs(final.stress[i] - final.stress[mirror]) <= 1e-9);  // strain rounding 1e-12 times E = 100
  }
}

TEST_CASE("a column hanging from the right end is the mirror image of one standing on the left") {
  const auto standing = built_in("column", "large", {{"scheme.cells", "16"}, {"end_time", "0.2"}});
  auto hanging = standing;
  std::swap(hanging.ends.left, hanging.ends.right);
  hanging.effects.front().parameters["acceleration"] = 9.81;
  const auto a = hompm::run(standing, hompm::time_stepping(standing)).final;
  const auto b = hompm::run(hanging, hompm::time_stepping(hanging)).final;
  for (std::size_t i = 0; i < a.size(); ++i)
    CHECK(std::abs(a.displacement[i] + b.displacement[b.size() - 1 - i]) <= 1e-12);  // rounding of 2000 steps
}

TEST_CASE("the state can be looked at without leave to change it") {
  const Simulation simulation(free_body(), 1e-3);
  CHECK(simulation.state().particles.size() == 64);
}

TEST_CASE("two runs of one scene have the same bits") {
  const auto& scheme = GENERATE(from_range(hompm::scheme_table()));
  const auto scene = built_in("column", "large",
                              {{"scheme.name", scheme.name}, {"scheme.cells", "16"}, {"end_time", "0.05"}});
  const auto a = hompm::run(scene, hompm::time_stepping(scene)).final;
  const auto b = hompm::run(scene, hompm::time_stepping(scene)).final;
  CHECK(a.position == b.position);
  CHECK(a.velocity == b.velocity);
  CHECK(a.stress == b.stress);
}

TEST_CASE("outputs come at the steps nearest to their times, the last at the end") {
  const auto scene = built_in(
      "bar", "large",
      {{"scheme.cells", "4"}, {"end_time", "0.0013"}, {"output.snapshots", "4"}, {"output.history", "100"}});
  std::vector<double> snapshots;
  int rows = 0;
  hompm::run(scene, hompm::time_stepping(scene),
             {.snapshot = [&](const auto& s) { snapshots.push_back(s.time); },
              .history = [&](const auto&) { ++rows; },
              .progress = {}});
  CHECK(snapshots == std::vector<double>{0.0, 3 * 1e-4, 7 * 1e-4, 10 * 1e-4, 0.0013});
  CHECK(rows == 14);
}

TEST_CASE("the step asked for is kept, or shortened to end at the end time") {
  const auto kept = hompm::time_stepping(built_in("bar", "small"));
  CHECK(kept.time_step == 1e-4);
  CHECK(kept.steps == 25000);
  CHECK(kept.time(25000, 2.5) == 2.5);
  const auto shortened = hompm::time_stepping(built_in("bar", "small", {{"end_time", "0.00025"}}));
  CHECK(shortened.steps == 3);
  CHECK(shortened.time_step == 0.00025 / 3);
  const auto courant = hompm::time_stepping(built_in("bar", "small", {{"scheme.courant", "0.1"}}));
  CHECK(std::abs(courant.time_step - 0.1 * (25.0 / 64) / 10.0) <
        1e-5);  // shortened by at most one part in 640
  const auto fraction = hompm::time_stepping(built_in("bar", "small", {{"scheme.step_fraction", "0.5"}}));
  CHECK(fraction.time_step <= 0.5 * fraction.critical_time_step);
  CHECK(fraction.time_step > 0.49 * fraction.critical_time_step);
}

TEST_CASE("a step above the critical one is refused with the limit, and forced it ends as unstable") {
  const auto too_large = built_in("bar", "small", {{"scheme.step_fraction", "1.05"}});
  CHECK_THROWS_AS(hompm::time_stepping(too_large), hompm::SceneError);
  CHECK_THROWS_WITH(hompm::time_stepping(too_large), hompm::test::contains("above the critical step"));
  const auto forced =
      built_in("bar", "small",
               {{"scheme.step_fraction", "1.05"}, {"scheme.allow_unstable", "true"}, {"end_time", "100"}});
  CHECK_THROWS_AS(hompm::run(forced, hompm::time_stepping(forced)), hompm::InvalidRun);
}

TEST_CASE("a run at 0.98 of the critical step stays bounded") {
  const auto& scheme = GENERATE(from_range(hompm::scheme_table()));
  const auto scene = built_in("bar", "small",
                              {{"scheme.name", scheme.name},
                               {"scheme.step_fraction", "0.98"},
                               {"end_time", "100"},
                               {"initial.velocity.amplitude", "1e-6"}});
  const auto result = hompm::run(scene, hompm::time_stepping(scene));
  CHECK(result.end.kinetic + result.end.stored < 2.0 * (result.start.kinetic + result.start.stored));
}

TEST_CASE("a body that leaves the grid is an error, never a silent zero") {
  const auto flying = [](const char* velocity_sign) {
    auto scene = free_body({{"scheme.margin_cells", "4"}, {"end_time", "10"}});
    Simulation simulation(scene, 1e-3);
    auto& p = simulation.state().particles;
    std::fill(p.velocity.begin(), p.velocity.end(), std::string(velocity_sign) == "-" ? -1.0 : 1.0);
    for (int step = 0; step < 10000; ++step) simulation.step();
  };
  CHECK_THROWS_AS(flying("+"), hompm::InvalidRun);
  CHECK_THROWS_WITH(flying("-"), hompm::test::contains("left the grid"));
  auto scene = free_body({{"scheme.name", "classical"}, {"scheme.margin_cells", "4"}});
  Simulation simulation(scene, 1e-3);
  simulation.state().particles.position[3] = 1e6;
  CHECK_THROWS_WITH(simulation.plan().run(Phase::geometry, simulation.state()),
                    hompm::test::contains("particle 3"));
}

TEST_CASE("invalid states are found where they arise") {
  Simulation simulation(free_body(), 1e-3);
  auto& state = simulation.state();
  auto& p = state.particles;
  SECTION("particles out of order") {
    std::swap(p.position[10], p.position[11]);
    CHECK_THROWS_WITH(simulation.plan().run(Phase::geometry, state), hompm::test::contains("particle 11"));
  }
  SECTION("a density spline that is not positive") {
    for (std::size_t i = 30; i < 40; ++i) p.stretch[i] = i % 2 == 0 ? 1e-9 : 1.0;
    CHECK_THROWS_WITH(simulation.plan().run(Phase::geometry, state), hompm::test::contains("density spline"));
  }
  SECTION("an inverted particle") {
    for (std::size_t i = 0; i < p.size(); ++i) p.velocity[i] = -2000.0 * p.position[i];
    CHECK_THROWS_WITH(simulation.step(), hompm::test::contains("inverted"));
  }
  SECTION("not a number") {
    p.position[5] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(simulation.plan().run(Phase::geometry, state), hompm::test::contains("particle 5"));
  }
}

TEST_CASE("schemes that reconstruct refuse a single particle") {
  CHECK_THROWS_AS(Simulation(free_body({{"scheme.cells", "1"}, {"scheme.particles_per_cell", "1"}}), 1e-3),
                  hompm::SceneError);
  CHECK_NOTHROW(Simulation(
      free_body({{"scheme.cells", "1"}, {"scheme.particles_per_cell", "1"}, {"scheme.name", "bspline"}}),
      1e-3));
}

TEST_CASE("the kinetic energy at the start is that of the particles") {
  const Simulation simulation(built_in("bar", "large"), 1e-4);
  const auto start = simulation.snapshot(0.0);
  double kinetic = 0.0;
  for (const double v : start.velocity) kinetic += 0.5 * (25.0 / 256.0) * v * v;
  CHECK(std::abs(simulation.history(0.0).kinetic / kinetic - 1.0) < 1e-14);  // rounding of 256 terms
}

TEST_CASE("a body that never moves is at rest after the time of a wave there and back") {
  const auto scene = free_body({{"rest.speed", "1e-6"}, {"end_time", "3"}});
  const auto result = run(scene, hompm::time_stepping(scene));
  CHECK(result.at_rest);
  CHECK(result.steps == 2000);  // of 1e-3 s; 1 m there and back at 1 m/s
}

TEST_CASE("the largest values of a run are those of its rows") {
  auto scene = hompm::test::busy_scene("high-order", 3, "leapfrog", "finite");
  scene.output.snapshots = 1;
  const auto run = hompm::test::record_run(scene, 0);
  hompm::RunExtremes most;
  const auto raise = [](double& largest, double value) { largest = std::max(largest, std::abs(value)); };
  for (const hompm::HistoryRow& row : run.reported.history) {
    raise(most.largest_residual, row.residual);
    raise(most.largest_momentum_residual, row.momentum_residual);
    raise(most.largest_internal_force_sum, row.internal_force_sum);
    raise(most.largest_energy, row.kinetic + row.stored + std::abs(row.gravity));
    raise(most.largest_momentum, std::abs(row.momentum) + std::abs(row.impulse));
  }
  CHECK(run.result.largest_residual == most.largest_residual);
  CHECK(run.result.largest_momentum_residual == most.largest_momentum_residual);
  CHECK(run.result.largest_internal_force_sum == most.largest_internal_force_sum);
  CHECK(run.result.largest_energy == most.largest_energy);
  CHECK(run.result.largest_momentum == most.largest_momentum);
}
