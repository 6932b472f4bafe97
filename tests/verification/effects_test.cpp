// Each effect against its closed form, and the energy it books against the energy that is missing.
#include <cmath>
#include <string>

#include <hompm/kit/verify/judge.hpp>
#include <hompm/numerics/elementary.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace {

struct Outcome {
  hompm::RunResult result;
  hompm::ErrorReport errors;
};

Outcome run(const std::string& toml, const std::string& cells) {
  const auto scene = hompm::parse_scene(toml, "effects test", {{"scheme.cells", cells, "--cells"}});
  Outcome outcome;
  outcome.result = hompm::run(scene, hompm::time_stepping(scene));
  std::string reason;
  const auto errors = hompm::judge(scene, outcome.result, reason);
  INFO(reason);
  REQUIRE(errors);
  outcome.errors = *errors;
  return outcome;
}

/// Order of convergence in displacement from 32 to 64 cells.
double order(const std::string& toml) {
  return std::log2(run(toml, "32").errors.displacement.relative_l2 /
                   run(toml, "64").errors.displacement.relative_l2);
}

std::string scene(const std::string& rest, const std::string& law = "rate") {
  return R"(
end_time = 0.25
body.length = 1
material = { law = ")" +
         law + R"(", density = 1000, youngs_modulus = 1e5 }
scheme = { cells = 16, particles_per_cell = 4, time_step = 1e-5 }
)" + rest;
}

}  // namespace

TEST_CASE("gravity on small strains follows the series solution") {
  const auto toml =
      scene("ends.right = \"free\"\n[[effect]]\ntype = \"gravity\"\nacceleration = -9.81\n", "linear");
  const auto outcome = run(toml, "64");
  CHECK(outcome.errors.reference_errors.displacement == 0.0);
  CHECK(outcome.errors.displacement.relative_l2 < 1e-3);
  // residual: the work of a first-order integrator, Δt/2 times the power
  CHECK(outcome.result.largest_residual < 1e-3 * outcome.result.largest_energy);
}

TEST_CASE("a step traction sends a front through the body: the loaded end moves with p/(rho c)") {
  const auto toml = scene(
      "ends.right = \"free\"\n[[effect]]\ntype = \"traction\"\nvalue = 100\nend = \"right\"\n", "linear");
  auto scene = hompm::parse_scene(toml, "traction",
                                  {{"scheme.cells", "128", "--cells"}, {"end_time", "0.05", "--end-time"}});
  const auto result = hompm::run(scene, hompm::time_stepping(scene));
  // d'Alembert: tip velocity p/(ρ c) = 0.01 m/s until the front is back at 2 L/c = 0.2 s. The front is 1/128
  // m wide on this grid and the last particle half a spacing inside: 1 % of the 0.5 m it has run.
  CHECK(std::abs(result.final.displacement.back() - 0.01 * 0.05) < 0.02 * 0.01 * 0.05);
  CHECK(std::abs(result.end.external_work - 100 * 0.01 * 0.05) < 0.02 * 100 * 0.01 * 0.05);
  CHECK(result.largest_momentum_residual < 1e-10 * result.largest_momentum);
  CHECK(result.largest_residual < 0.01 * result.end.external_work);
}

TEST_CASE("tension on the left free end pulls to the left, and mirrors the right") {
  const auto at = [](const std::string& ends, const std::string& end) {
    const auto toml = scene(ends + "\n[[effect]]\ntype = \"traction\"\nvalue = 100\nend = \"" + end + "\"\n");
    return run(toml, "16").result.final;
  };
  const auto left = at("ends.left = \"free\"", "left");
  const auto right = at("ends.right = \"free\"", "right");
  CHECK(left.displacement.front() < 0.0);
  for (std::size_t i = 0; i < left.size(); ++i)
    CHECK(std::abs(left.displacement[i] + right.displacement[left.size() - 1 - i]) < 1e-12);
}

TEST_CASE("a traction in the large follows the reference solution, at the order its kinks allow") {
  const auto toml = scene("ends.right = \"free\"\n[[effect]]\ntype = \"traction\"\nvalue = -5000\n");
  CHECK(order(toml) > 0.9);
  CHECK(run(toml, "64").errors.displacement.relative_l2 < 1e-2);
}

TEST_CASE("mass-proportional damping makes a mode decay with half its rate, and books what it takes") {
  const auto toml = scene(
      "initial.velocity = { shape = \"sine\", amplitude = 1e-3 }\n[[effect]]\ntype = \"mass-damping\"\nrate "
      "= 8\n",
      "linear");
  const auto scene = hompm::parse_scene(toml, "damping", {{"scheme.cells", "64", "--cells"}});
  const auto result = hompm::run(scene, hompm::time_stepping(scene));
  const double omega = hompm::numerics::pi * 10.0;
  const double damped = std::sqrt(omega * omega - 16.0);
  const double amplitude =
      1e-3 / damped * hompm::numerics::exp(-4.0 * 0.25) * hompm::numerics::sin(damped * 0.25);
  for (std::size_t i = 0; i < result.final.size(); i += 17) {
    const double exact = amplitude * hompm::numerics::sin_pi(result.final.reference_position[i]);
    CHECK(std::abs(result.final.displacement[i] - exact) <
          2e-3 * std::abs(amplitude));  // second order on 64 cells: 1e-3
  }
  const double lost = result.start.kinetic - result.end.kinetic - result.end.stored;
  CHECK(std::abs(result.end.dissipated - lost) < 1e-3 * lost);
  CHECK(run(toml, "16").errors.displacement.relative_l2 < 0.05);
  CHECK(order(toml) > 1.9);
}

TEST_CASE("local damping takes energy from a column and never adds any") {
  const auto toml = scene(
      "ends.right = \"free\"\n[[effect]]\ntype = \"gravity\"\nacceleration = -9.81\n"
      "[[effect]]\ntype = \"local-damping\"\ncoefficient = 0.5\n");
  const auto scene = hompm::parse_scene(toml, "local damping", {});
  double before = 0.0;
  int rows = 0;
  const auto result = hompm::run(scene, hompm::time_stepping(scene),
                                 {.snapshot = {},
                                  .history =
                                      [&](const auto& row) {
                                        CHECK(row.dissipated >= before);
                                        before = row.dissipated;
                                        ++rows;
                                      },
                                  .progress = {}});
  CHECK(rows == 101);
  CHECK(result.end.dissipated > 0.1 * std::abs(result.end.gravity));
  CHECK(result.largest_residual < 5e-3 * result.largest_energy);
  std::string reason;
  CHECK_FALSE(hompm::judge(scene, result, reason));
  CHECK(reason == "no reference solution is known for this scene");
}

TEST_CASE("every law vibrates as its own reference solution says") {
  const std::string law = GENERATE(as<std::string>{}, "linear", "rate", "hencky", "neo-hookean");
  const auto toml = scene("initial.velocity = { shape = \"sine\", amplitude = 0.5 }\n", law);
  INFO(law);
  CHECK(order(toml) > 1.85);
  CHECK(run(toml, "64").errors.displacement.relative_l2 < 3e-3);
}
