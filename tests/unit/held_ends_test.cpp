// Conditions on the velocity of a free end against closed forms: piston, rigid wall, absorbing end, and none.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <hompm/numerics/elementary.hpp>
#include <hompm/scene/amplitude.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace {

hompm::Scene example(const std::string& name, const std::string& scheme, const std::string& degree,
                     const std::string& cells, std::vector<hompm::Override> more = {}) {
  more.push_back({"scheme.name", scheme, "--scheme"});
  more.push_back({"scheme.degree", degree, "--degree"});
  more.push_back({"scheme.cells", cells, "--cells"});
  return hompm::load_scene(HOMPM_SOURCE_DIR "/docs/scenes/" + name + ".toml", more);
}

hompm::RunResult run(const hompm::Scene& scene) { return hompm::run(scene, hompm::time_stepping(scene)); }

struct SimpleWave {
  double amplitude;
  hompm::Amplitude growth;

  /// v at (X, t): that of the piston at the time s with X = c e^{v/c} (t − s), c = 1.
  [[nodiscard]] double velocity(double X, double time) const {
    double low = 0.0;
    double high = time;
    for (int round = 0; round < 60; ++round) {
      const double s = 0.5 * (low + high);
      (hompm::numerics::exp(amplitude * growth(s)) * (time - s) > X ? low : high) = s;
    }
    return amplitude * growth(low);
  }
};

struct Errors {
  double velocity = 0.0, stress = 0.0;
};

/// Relative L2 errors of the piston's simple wave.
Errors piston_errors(const std::string& scheme, const std::string& degree, const std::string& cells) {
  const auto result = run(example("piston", scheme, degree, cells));
  const SimpleWave wave{0.1, {.ramp_time = 0.5}};
  const auto& final = result.final;
  double dv = 0.0, v2 = 0.0, ds = 0.0, s2 = 0.0;
  for (std::size_t i = 0; i < final.size(); ++i) {
    const double v = wave.velocity(final.reference_position[i], final.time);
    const double s = 1.0 - hompm::numerics::exp(v);  // E (1 − 1/λ), λ = e^{−v/c}
    dv += (final.velocity[i] - v) * (final.velocity[i] - v);
    ds += (final.stress[i] - s) * (final.stress[i] - s);
    v2 += v * v;
    s2 += s * s;
  }
  CHECK(std::abs(result.end.residual) < 0.03 * result.end.external_work);
  return {std::sqrt(dv / v2), std::sqrt(ds / s2)};
}

}  // namespace

TEST_CASE("a piston sends the exact nonlinear simple wave, at the order of the scheme") {
  // From 16 to 32 cells. high-order: p + 1 in velocity and p in stress. tielen2017 and bspline: the piston
  // acts on the line through two particles, first order.
  struct Case {
    std::string scheme, degree;
    double velocity_order, stress_order;
  };
  const auto& c = GENERATE(values<Case>({{"high-order", "2", 2.9, 2.0},
                                         {"high-order", "3", 3.9, 3.0},
                                         {"tielen2017", "2", 0.9, 0.7},
                                         {"bspline", "2", 0.85, 0.85}}));
  INFO(c.scheme << ' ' << c.degree);
  const Errors coarse = piston_errors(c.scheme, c.degree, "16");
  const Errors fine = piston_errors(c.scheme, c.degree, "32");
  CHECK(std::log2(coarse.velocity / fine.velocity) > c.velocity_order);
  CHECK(std::log2(coarse.stress / fine.stress) > c.stress_order);
}

TEST_CASE(
    "a bar rebounds from a rigid wall with the speed of its impact after 2L/c, at the order that a jump "
    "allows, and never enters the wall") {
  // What waves out of place keep of the energy of a jump, and the width of its front, are of order q/(q + 1)
  // for waves with speeds of order q (docs/method.md, Jumps): 2 with lumped mass; high-order is far from its
  // limit in time, 6 in space. Bounds: factors as measured from 16 to 256 cells, and a quarter.
  struct Case {
    std::string scheme, degree;
    double order, loss, time;
  };
  const auto& c = GENERATE(values<Case>({{"classical", "1", 2.0 / 3.0, 0.55, 0.55},
                                         {"bspline", "2", 2.0 / 3.0, 0.7, 0.6},
                                         {"tielen2017", "2", 2.0 / 3.0, 0.55, 0.4},
                                         {"high-order", "3", 6.0 / 7.0, 0.3, 0.25}}));
  INFO(c.scheme);
  struct Rebound {
    double loss, time;
  };
  const auto rebound = [&](const std::string& cells) {
    const auto scene =
        example("wall", c.scheme, c.degree, cells, {{"output.history", "1000000", "--set"}});  // each step
    std::vector<hompm::HistoryRow> rows;
    const auto result = hompm::run(
        scene, hompm::time_stepping(scene),
        {.snapshot = {}, .history = [&](const auto& row) { rows.push_back(row); }, .progress = {}});
    const auto when = [&](auto holds) { return std::ranges::find_if(rows, holds)->time; };
    const double closed = when([](const auto& row) { return row.impulse != 0.0; });
    const double opened = when([&](const auto& row) { return row.impulse == result.end.impulse; });
    CHECK(result.end.dissipated >= 0.0);
    CHECK(std::abs(result.end.residual) < 0.03 * result.start.kinetic);
    // Impulse is what the particles got, but for what the density of high-order keeps of their masses: O(h²).
    CHECK(std::abs(result.end.momentum_residual) < 1e-4 * result.start.momentum);
    double furthest = 0.0;
    for (const double x : result.final.position) furthest = std::max(furthest, x);
    CHECK(furthest < 1.02);
    const double limit = std::pow(std::stod(cells), -c.order);
    const Rebound found{1.0 + result.end.momentum / result.start.momentum, std::abs(opened - closed - 2.0)};
    CHECK(found.loss < c.loss * limit);
    CHECK(found.time < c.time * limit);
    return found;
  };
  const double order = std::log2(rebound("16").loss / rebound("64").loss) / 2.0;
  CAPTURE(order);
  CHECK(order > c.order - 0.05);
  CHECK(order < 1.0);  // a jump permits no more
}

TEST_CASE("the gap to a wall closes to rounding and no further") {
  auto scene = example("wall", "high-order", "3", "16");
  hompm::Simulation simulation(scene, 5e-3);
  double least = 1.0;
  for (int step = 0; step < 600; ++step) {
    simulation.step();
    const auto& p = simulation.state().particles;
    least = std::min(least, 1.02 - (p.reference_position.back() + p.displacement.back()));
  }
  // The marker is moved by the grid, and by the null-space relaxation: its part of a step, Δt/τ = 0.016, of
  // what the grid does not see of the displacement.
  CHECK(least > -1e-5);
  CHECK(least < 1e-5);
}

TEST_CASE("a wall at the left end mirrors one at the right") {
  const auto right = run(example("wall", "high-order", "2", "8"));
  const auto left = run(example("wall", "high-order", "2", "8",
                                {{"effect[0].end", "left", "--set"},
                                 {"effect[0].position", "-0.02", "--set"},
                                 {"initial.velocity.amplitude", "-0.1", "--set"}}));
  for (std::size_t i = 0; i < left.final.size(); ++i)
    CHECK(std::abs(left.final.velocity[i] + right.final.velocity[left.final.size() - 1 - i]) < 1e-9);
}

TEST_CASE("an absorbing end reflects less than 1 % of the energy that reaches it, and books what it takes") {
  const std::string law = GENERATE(as<std::string>{}, "linear", "neo-hookean");
  const std::string scheme = GENERATE(as<std::string>{}, "bspline", "tielen2017", "high-order");
  INFO(scheme << ' ' << law);
  const auto scene = example("absorbing", scheme, scheme == "high-order" ? "3" : "2", "64",
                             {{"material.law", law, "--set"}, {"effect[0].velocity", "0.02", "--set"}});
  const auto result = run(scene);
  const double sent = result.end.external_work;
  CHECK((result.end.kinetic + result.end.stored) / sent < 0.01);
  CHECK(std::abs(result.end.dissipated / sent - 1.0) < 0.03);
}

TEST_CASE("the impedance of an absorbing end is that of the strained material") {
  // A step of v = 0.2 c in the law rate is a shock of impedance ρ0 c/√λ: behind it, the end neither pushes
  // nor gives way. √λ = (−0.2 + √4.04)/2.
  auto scene = example("absorbing", "high-order", "2", "32",
                       {{"material.law", "rate", "--set"},
                        {"effect[0].velocity", "0.2", "--set"},
                        {"effect[0].ramp_time", "0.6", "--set"},
                        {"effect[0].duration", "0", "--set"},
                        {"end_time", "3", "--set"},
                        {"grid.to", "2", "--set"}});
  const auto result = run(scene);
  // A ramp of 0.6 s is a simple wave, λ = e^{−v/c}; the end's Z is off by (v/c)²/24 of itself.
  for (std::size_t i = 0; i < result.final.size(); ++i) {
    CHECK(std::abs(result.final.velocity[i] - 0.2) < 0.004);
    CHECK(std::abs(result.final.stress[i] - (1.0 - hompm::numerics::exp(0.2))) < 0.004);
  }
}

TEST_CASE("a body in rigid flight crosses 50 cells and more, exact to rounding") {
  const std::string scheme = GENERATE(as<std::string>{}, "classical", "bspline", "tielen2017", "high-order");
  const std::string degree = scheme == "classical" ? "1" : scheme == "high-order" ? "3" : "2";
  const auto result = run(example("flight", scheme, degree, "16"));
  INFO(scheme);
  for (std::size_t i = 0; i < result.final.size(); ++i) {
    // Rounding of a position is 2e-16, of about 1000 steps that add up at worst, times 1/h in the strain.
    CHECK(std::abs(result.final.displacement[i] - 0.5 * 6.25) < 1e-11);
    CHECK(std::abs(result.final.stress[i]) < 1e-10);
  }
}

TEST_CASE("what holds an end does not lower the critical step") {
  const std::string scheme = GENERATE(as<std::string>{}, "classical", "bspline", "tielen2017", "high-order");
  const std::string degree = scheme == "classical" ? "1" : "2";
  const std::string velocity = GENERATE(as<std::string>{}, "0", "0.01");
  INFO(scheme << ' ' << velocity);
  const auto scene = hompm::parse_scene(R"(
end_time = 30
body.length = 1
material = { law = "linear", density = 1, youngs_modulus = 1 }
ends = { left = "free", right = "free" }
initial.velocity = { shape = "sine", amplitude = 0.1 }
effect = [ { type = "piston", end = "right", velocity = )" +
                                            velocity + R"( } ]
scheme = { name = ")" + scheme + R"(", degree = )" +
                                            degree +
                                            R"(, cells = 16, particles_per_cell = 4, step_fraction = 0.95 })",
                                        "held end", {});
  CHECK_NOTHROW(run(scene));  // the guard on the energy stops what grows
}

TEST_CASE("a body with free ends keeps its energy when it does not move through the grid, on either side") {
  // A velocity that the forces do not see, of a function beyond the body, would stretch it more and more: by
  // four times its energy here within forty crossings.
  const auto energy = [](const std::string& left, const std::string& right) {
    const auto scene = hompm::test::free_body({{"material.law", "linear"},
                                               {"kinematics", "infinitesimal"},
                                               {"scheme.name", "high-order"},
                                               {"scheme.degree", "2"},
                                               {"scheme.cells", "8"},
                                               {"ends.left", left},
                                               {"ends.right", right},
                                               {"initial.velocity.shape", "sine"},
                                               {"initial.velocity.amplitude", "0.1"},
                                               {"scheme.time_step", "0.01"},
                                               {"end_time", "40"}});
    const auto result = run(scene);
    return (result.end.kinetic + result.end.stored) / result.start.kinetic - 1.0;
  };
  CHECK(std::abs(energy("free", "free")) < 5e-3);
  CHECK(std::abs(energy("free", "fixed")) < 5e-3);
  CHECK(std::abs(energy("fixed", "free") - energy("free", "fixed")) < 1e-6);
}
