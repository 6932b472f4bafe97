// Particles as material point methods do not like them (docs/stability.md, "Hard cases"): few, uneven,
// clustered, inverted, very many. Each case has a number or a message.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/scheme/scheme.hpp>

#include "stability/hard_cases.hpp"
#include "support/catch.hpp"
#include "support/message_of.hpp"

namespace {

using hompm::Phase;
using hompm::Scene;
using hompm::Simulation;
using hompm::test::all_schemes;
using hompm::test::contains;
using hompm::test::hard;
using hompm::test::larger;
using hompm::test::largest;
using hompm::test::message_of;
using hompm::test::reconstructs;
using hompm::test::shown;

/// How far every third particle is shifted to the right, and the next to the left, so that of neighbouring
/// distances one is `ratio` times the other; in spacings.
double shift_of(double ratio) { return (ratio - 1.0) / (2.0 * ratio + 1.0); }

/// Shifts the particles so, in place or by displacements.
void make_uneven(hompm::Particles& p, double ratio, double spacing) {
  for (std::size_t i = p.markers; i < p.size() - p.markers; ++i) {
    const double shift = (i % 3 == 0 ? shift_of(ratio) : i % 3 == 1 ? -shift_of(ratio) : 0.0) * spacing;
    p.position[i] += shift;
    p.displacement[i] += shift;
  }
}

bool is_named(const std::string& message) {
  const auto is = [&](const char* part) { return contains(message, part); };
  return is("passed its left neighbour") || is("density spline is not positive") || is("inverted") ||
         is("unstable") || is("left the grid");
}

}  // namespace

TEST_CASE("constant stress in particles uneven by 10:1 makes no force inside, with reconstruction") {
  const std::string scheme = GENERATE(as<std::string>{}, "classical", "bspline", "tielen2017", "high-order");
  for (const double ratio : {1.0, 2.0, 4.0, 8.0, 10.0}) {
    Simulation simulation(hard("constant-stress", {{"scheme.name", scheme}}), 1e-4);
    hompm::State& state = simulation.state();
    make_uneven(state.particles, ratio, 25.0 / 64.0);
    std::fill(state.particles.stress.begin(), state.particles.stress.end(), 1.0);
    for (const Phase phase : {Phase::geometry, Phase::total_stress, Phase::end_stress, Phase::internal_force})
      simulation.plan().run(phase, state);
    const auto& force = state.fields.internal_force;
    double inside = 0.0;
    for (std::size_t i = 1; i + 1 < force.size(); ++i) inside = larger(inside, std::abs(force[i]));
    CHECK(std::abs(force.back() - 1.0) <
          0.1);  // the ends bear it; a lumped one knows where it is to first order
    INFO(scheme << ", " << ratio << ":1: " << inside);
    shown("constant-stress", scheme, ratio, inside);
    if (reconstructs(scheme))
      CHECK(inside < 1e-13);
    else if (scheme == "bspline" && ratio > 1.0)
      CHECK(inside > 1e-2);  // hat functions have one gradient in a cell: they see how many, not where
  }
}

TEST_CASE("with one particle per cell a scene runs or is refused with what to change") {
  const std::string name = GENERATE(as<std::string>{}, "classical", "bspline", "tielen2017", "high-order");
  const auto& scheme = hompm::find_scheme(name);
  for (int degree = scheme.lowest_degree; degree <= scheme.highest_degree; ++degree) {
    INFO(name << " p = " << degree);
    const Scene scene =
        hard("few-particles", {{"scheme.name", name}, {"scheme.degree", std::to_string(degree)}});
    const bool refused = reconstructs(name) && degree >= 3;
    shown("few-particles", name, degree, refused ? 0.0 : 1.0);
    if (refused) {
      CHECK_THAT(message_of<hompm::SceneError>([&] { hompm::time_stepping(scene); }),
                 contains("raise scheme.particles_per_cell, or lower "));
      continue;
    }
    const auto result = hompm::run(scene, hompm::time_stepping(scene));
    CHECK(result.end.kinetic + result.end.stored < 2.0 * result.start.kinetic);
  }
}

TEST_CASE("a body of two particles runs or is refused") {
  const std::string name = GENERATE(as<std::string>{}, "classical", "bspline", "tielen2017", "high-order");
  INFO(name);
  try {
    const Scene scene = hard("two-particles", {{"scheme.name", name}});
    const auto result = hompm::run(scene, hompm::time_stepping(scene));
    CHECK(result.end.mass == result.start.mass);
    const double residual = result.largest_residual / result.largest_energy;
    shown("two-particles", name, 2.0, residual);
    INFO(residual);
    CHECK(residual < 0.05);
    CHECK(std::abs(result.end.momentum - 0.5) < 1e-3);
  } catch (const hompm::SceneError& error) {
    CHECK(name == "high-order");
    CHECK_THAT(error.what(), contains("scheme.particles_per_cell"));
  }
}

TEST_CASE("clustered and very uneven particles are bounded, or an error names them") {
  const std::string scheme = GENERATE(as<std::string>{}, "classical", "bspline", "tielen2017", "high-order");
  const bool clustered = GENERATE(true, false);
  const Scene scene =
      hard("clustered", {{"scheme.name", scheme}, {"scheme.step_fraction", clustered ? "0.2" : "0.1"}});
  Simulation simulation(scene, hompm::time_stepping(scene).time_step);
  hompm::Particles& p = simulation.state().particles;
  const double h = 25.0 / 16.0;
  const std::size_t at = p.size() / 2;
  if (clustered) {
    p.displacement[at] = p.position[at - 1] + 1e-10 * h - p.reference_position[at];
    p.position[at] = p.reference_position[at] + p.displacement[at];
    p.velocity[at] = p.velocity[at - 1];
  } else {
    make_uneven(p, 10.0, h / 4.0);
  }
  INFO(scheme << (clustered ? ", two at 1e-10 cells" : ", 10:1"));
  try {
    for (int step = 0; step < 200; ++step) simulation.step();
    const double fastest = largest(simulation, [](const auto& q, auto i) { return q.velocity[i]; });
    shown("clustered", scheme, clustered ? 1e-10 : 10.0, fastest);
    CHECK(fastest < 20.0);
  } catch (const hompm::InvalidRun& error) {
    // A spline through data so close has no bound: it is left before its values are used.
    INFO(error.what());
    CHECK(reconstructs(scheme));
    CHECK(is_named(error.what()));
  }
}

TEST_CASE("a front too steep for the density spline is reported, not used") {
  const std::string scheme = GENERATE(as<std::string>{}, "tielen2017", "high-order");
  const Scene scene = hard("density-overshoot", {{"scheme.name", scheme}});
  Simulation simulation(scene, 1e-4);
  hompm::Particles& p = simulation.state().particles;
  p.stretch[p.size() / 2] = 1e-3;  // one particle a thousand times as dense as its neighbours
  CHECK_THAT(
      message_of<hompm::InvalidRun>([&] { simulation.plan().run(Phase::geometry, simulation.state()); }),
      contains("particle ") && contains("the density spline is not positive at x = "));
  // And as it comes about: the impact itself.
  bool positive = true;
  hompm::RunObserver observer;
  observer.snapshot = [&](const hompm::Snapshot& s) {
    for (const double density : s.density) positive = positive && density > 0.0;
  };
  const auto message =
      message_of<hompm::InvalidRun>([&] { hompm::run(scene, hompm::time_stepping(scene), observer); });
  INFO(scheme << ": " << message);
  CHECK(positive);
  // high-order comes through: relaxation takes away what would overshoot.
  CHECK((scheme == "high-order" ? message.empty() : contains("density spline").match(message)));
}

TEST_CASE("an impact that inverts particles stops with the particle, the step and the time") {
  const std::string scheme = GENERATE(as<std::string>{}, "classical", "bspline", "tielen2017", "high-order");
  const Scene scene = hard("inverted", {{"scheme.name", scheme}});
  const auto message = message_of<hompm::InvalidRun>([&] { hompm::run(scene, hompm::time_stepping(scene)); });
  INFO(scheme << ": " << message);
  CHECK_THAT(message, contains("invalid at step ") && contains("particle "));
  CHECK(is_named(message));
}

TEST_CASE("a step of 1.05 of the limit is refused, and forced it ends as unstable") {
  for (const auto& name : all_schemes) {
    INFO(name);
    const Scene scene = hard("step-too-large", {{"scheme.name", name}});
    CHECK_THAT(message_of<hompm::SceneError>([&] { hompm::time_stepping(scene); }),
               contains("above the critical step"));
    const Scene forced = hard("step-too-large", {{"scheme.name", name}, {"scheme.allow_unstable", "true"}});
    double start = 0.0;
    hompm::RunObserver observer;
    observer.history = [&](const hompm::HistoryRow& row) {
      if (row.time == 0.0) start = row.kinetic + row.stored;
      shown("step-too-large", name, row.time, (row.kinetic + row.stored) / start);
    };
    const auto message =
        message_of<hompm::InvalidRun>([&] { hompm::run(forced, hompm::time_stepping(forced), observer); });
    INFO(message);
    CHECK_THAT(message, contains("invalid at step ") && contains("here the time step is too large"));
  }
}

TEST_CASE("velocity noise that the grid does not see stays bounded, and high-order removes it") {
  const std::string scheme = GENERATE(as<std::string>{}, "classical", "bspline", "tielen2017", "high-order");
  const Scene scene = hard("null-space", {{"scheme.name", scheme}});
  Simulation simulation(
      scene,
      hompm::time_stepping(hard("null-space", {{"scheme.name", scheme}, {"end_time", "100"}})).time_step);
  hompm::Particles& p = simulation.state().particles;
  const double noise = 1e-3;
  for (std::size_t i = p.markers; i < p.size() - p.markers; ++i)
    p.velocity[i] = (i % 2 == 0 ? noise : -noise);  // two and two in a cell: its mean is nothing
  double left = 1.0;
  for (int step = 1; step <= 2000; ++step) {
    simulation.step();
    if (step % 50 != 0) continue;
    left = largest(simulation, [](const auto& q, auto i) { return q.velocity[i]; }) / noise;
    shown("null-space", scheme, step, left);
  }
  INFO(scheme << ": " << left);
  CHECK(left < (scheme == "high-order" ? 0.2 : 3.0));
}

TEST_CASE("a million particles: mass, momentum and energy to rounding") {
  const Scene scene = hard("million-particles");
  const auto result = hompm::run(scene, hompm::time_stepping(scene));
  CHECK(result.steps == 20);
  CHECK(result.final.size() == 1'000'000);
  CHECK(result.end.mass == result.start.mass);
  CHECK(std::abs(result.end.mass - 25.0) < 3e-9);  // a million roundings of a sum of 25
  const double momentum = result.largest_momentum_residual / result.largest_momentum;
  shown("million-particles", "bspline", 1e6, momentum);
  CHECK(momentum < 1e-12);
  CHECK(std::abs(result.end.stored / 5e-7 - 1.0) < 2e-4);
}
