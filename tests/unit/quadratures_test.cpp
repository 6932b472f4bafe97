// What the quadratures promise: no force inside a body of constant stress, conservation, no jump of the force
// when a particle crosses a breakpoint.
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <hompm/numerics/elementary.hpp>
#include <hompm/simulation/simulation.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

using hompm::Phase;
using hompm::Simulation;
using hompm::State;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A free body on 16 cells of 1/16 m, three to five particles in each, at uneven places.
Simulation uneven_body(const std::string& scheme, const std::string& degree) {
  Simulation simulation(hompm::test::free_body({{"scheme.name", scheme}, {"scheme.degree", degree}}), 1e-3);
  auto& x = simulation.state().particles.position;
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] += 0.3 / 64.0 * (1.0 + hompm::numerics::sin(static_cast<double>(i * i)));
  return simulation;
}

const std::vector<double>& internal_force(Simulation& simulation) {
  simulation.plan().run(Phase::geometry, simulation.state());
  simulation.plan().run(Phase::total_stress, simulation.state());
  simulation.plan().run(Phase::internal_force, simulation.state());
  return simulation.state().fields.internal_force;
}

/// The largest change of an internal force when particle 32, on the right of the breakpoint in the middle,
/// comes to lie on its left.
double jump(const std::string& scheme, double constant, double slope) {
  Simulation simulation(hompm::test::free_body({{"scheme.name", scheme}}), 1e-3);
  auto& p = simulation.state().particles;
  std::vector<double> before;
  for (const double x : {0.5 + 1e-12, 0.5 - 1e-12}) {
    p.position[32] = x;
    for (std::size_t i = 0; i < p.size(); ++i) p.stress[i] = constant + slope * p.reference_position[i];
    const auto& force = internal_force(simulation);
    if (before.empty()) before = force;
  }
  double largest = 0.0;
  const auto& after = simulation.state().fields.internal_force;
  for (std::size_t i = 0; i < after.size(); ++i) largest = std::max(largest, std::abs(after[i] - before[i]));
  return largest;
}

}  // namespace

TEST_CASE("a constant stress gives no force inside, however particles lie") {
  const auto [scheme, degree] = GENERATE(table<std::string, std::string>(
      {{"mls", "1"}, {"mls", "2"}, {"mls", "3"}, {"tls", "1"}, {"tls", "2"}, {"tls", "3"}, {"mixed", "1"}}));
  auto simulation = uneven_body(scheme, degree);
  auto& stress = simulation.state().particles.stress;
  std::fill(stress.begin(), stress.end(), 7.0);
  const auto& force = internal_force(simulation);
  // The functions that do not touch the cells of the ends.
  const State& state = simulation.state();
  const int begin = state.grid.locate(state.left_boundary).cell + 1 + state.grid.degree();
  const int end = state.grid.locate(state.right_boundary).cell;
  REQUIRE(end - begin > 8);
  for (int i = begin; i < end; ++i)  // stress × rounding of gradients of 1/h = 16
    CHECK(std::abs(force[static_cast<std::size_t>(i)]) <= 7.0 * 32 * epsilon * 16);
}

TEST_CASE("cell-momentum keeps the momentum of the particles on the grid") {
  const auto lost = [](const std::string& scheme, const std::string& conserve) {
    const auto scene = hompm::test::built_in(
        "bar", "large", {{"scheme.name", scheme}, {"scheme.cells", "8"}, {"scheme.conserve", conserve}});
    Simulation simulation(scene, 1e-3);
    double largest = 0.0;
    for (int step = 0; step < 500; ++step) {
      simulation.step();
      const State& state = simulation.state();
      double momentum = 0.0;
      for (std::size_t i = 0; i < state.particles.size(); ++i)
        momentum += state.particles.mass[i] * state.particles.velocity[i];
      const auto& on_grid = state.fields.momentum;
      largest = std::max(largest, std::abs(std::accumulate(on_grid.begin(), on_grid.end(), -momentum)));
    }
    return largest;
  };
  for (const std::string scheme : {"tls", "mls", "tielen2017"}) {
    CHECK(lost(scheme, "cell-momentum") < 1e-12);  // rounding of 15.9 kg/(m s)
    CHECK(lost(scheme, "cell-mass") > 1e-4);
  }
}

TEST_CASE("mixed integration does not feel how many particles of a constant stress are in a cell") {
  CHECK(jump("mixed", 7.0, 0.0) <= 7.0 * 4 * epsilon);  // two means of equal numbers
  CHECK(jump("classical", 7.0, 0.0) > 1.0);             // a quarter of the stress
  // Of a gradient it feels what the means change by: a part of the difference within two cells.
  CHECK(jump("mixed", 7.0, 1.0) < 0.5 * 2.0 / 16.0);
}

TEST_CASE("moving least squares do not feel that a particle crosses a breakpoint") {
  CHECK(jump("mls", 7.0, 1.0) < 1e-10);  // 2e-12 m times a stiffness of 16 breakpoints per metre
  CHECK(jump("classical", 7.0, 1.0) > 1.0);
  // Parabolas cell by cell do, but for a stress that is one parabola.
  CHECK(jump("tls", 7.0, 1.0) > 1e-4);
  CHECK(jump("tls", 7.0, 0.0) <= 7.0 * 32 * epsilon * 16);
}

TEST_CASE("mixed integration is particle quadrature where a free end cuts a cell") {
  const auto forces = [](const std::string& scheme) {
    Simulation simulation(hompm::test::free_body({{"scheme.name", scheme}, {"scheme.margin_cells", "6"}}),
                          1e-3);
    auto& p = simulation.state().particles;
    for (std::size_t i = 0; i < p.size(); ++i) {
      p.position[i] += 0.55 / 16.0;
      p.volume[i] *= 1.1;  // as if stretched: a full cell does not mind
      p.stress[i] = 7.0 + p.position[i];
    }
    return internal_force(simulation);
  };
  const auto mixed = forces("mixed");
  const auto particles = forces("classical");
  CHECK(std::abs(mixed[6] - particles[6]) < 1e-14);
  CHECK(std::abs(mixed[23] - particles[23]) < 1e-14);
  CHECK(std::abs(mixed[7] - particles[7]) > 0.5);  // a tenth of the stress in the first full cell
}

TEST_CASE("an emptied cell inside the body has no stress with mixed integration") {
  Simulation simulation(hompm::test::free_body({{"scheme.name", "mixed"}, {"scheme.margin_cells", "6"}}),
                        1e-3);
  auto& p = simulation.state().particles;
  std::fill(p.stress.begin(), p.stress.end(), 7.0);
  for (std::size_t i = 28; i < 32; ++i) p.position[i] = 0.4375 - 1e-4 * static_cast<double>(32 - i);
  const auto& force = internal_force(simulation);
  CHECK(force[12] == 0.0);
  CHECK(force[13] == 7.0);
  CHECK(force[14] == -7.0);
}
