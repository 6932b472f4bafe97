// Viscosities against closed forms: the damped mode, and the shock of the law `rate`.
#include <cmath>
#include <string>

#include <hompm/numerics/elementary.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace {

hompm::Scene vibrating(const std::string& scheme, int cells, double viscosity) {
  return hompm::parse_scene(R"(
end_time = 0.25
body.length = 1
material = { law = "linear", density = 1000, youngs_modulus = 1e5 }
initial.velocity = { shape = "sine", amplitude = 1e-3 }
effect = [ { type = "viscosity", viscosity = )" +
                                std::to_string(viscosity) + R"( } ]
scheme = { name = ")" + scheme + R"(", cells = )" +
                                std::to_string(cells) + R"(, particles_per_cell = 4, time_step = 2e-5 })",
                            "viscosity test", {});
}

/// σ = E ε + η ∂v/∂x: the mode sin(kX) decays with γ = η k²/(2ρ) while it swings with √(ω² − γ²).
double damped_mode(double X, double time, double viscosity) {
  const double k = hompm::numerics::pi;
  const double decay = viscosity * k * k / 2000.0;
  const double omega = std::sqrt(100.0 * k * k - decay * decay);
  return 1e-3 / omega * hompm::numerics::exp(-decay * time) * hompm::numerics::sin(omega * time) *
         hompm::numerics::sin_pi(X);
}

double error(const std::string& scheme, int cells) {
  const double viscosity = 400.0;
  const auto of = vibrating(scheme, cells, viscosity);
  const auto result = hompm::run(of, hompm::time_stepping(of));
  const double lost = result.start.kinetic - result.end.kinetic - result.end.stored;
  CHECK(std::abs(result.end.dissipated - lost) < 4e-3 * lost);  // second order: 3.6e-3 on 32 cells
  double difference = 0.0, size = 0.0;
  for (std::size_t i = 0; i < result.final.size(); ++i) {
    const double exact = damped_mode(result.final.reference_position[i], 0.25, viscosity);
    difference += std::pow(result.final.displacement[i] - exact, 2);
    size += exact * exact;
  }
  return std::sqrt(difference / size);
}

}  // namespace

TEST_CASE("a viscous mode decays with viscosity k^2/(2 density), at the order of the scheme") {
  CHECK(std::log2(error("tielen2017", 32) / error("tielen2017", 64)) > 1.8);
  // What is left is of the time step: the viscous stress is that of the velocity a step before.
  CHECK(error("high-order", 16) < 5e-5);
}

TEST_CASE("the critical step knows of a viscosity") {
  const std::string scheme = GENERATE(as<std::string>{}, "classical", "bspline", "tielen2017", "high-order");
  // η/E of 0.3, 30 and 300 times the critical step without viscosity, or so.
  const std::string viscosity = GENERATE(as<std::string>{}, "3.0", "300.0", "3000.0");
  const auto ends_well = [&](const std::string& fraction) {
    auto of = hompm::test::built_in(
        "bar", "small", {{"scheme.name", scheme}, {"scheme.cells", "32"}, {"initial.velocity.mode", "5"}});
    of.effects = {{"viscosity", {{"viscosity", std::stod(viscosity)}}, {}}};
    of.material.law = "linear";
    of.kinematics = hompm::Kinematics::infinitesimal;
    of.scheme.time_step.reset();
    of.scheme.step_fraction = std::stod(fraction);
    of.scheme.allow_unstable = true;
    const double step = hompm::time_stepping(of).time_step;
    of.end_time = 4000 * step;
    try {
      hompm::run(of, hompm::time_stepping(of));
      return true;
    } catch (const hompm::InvalidRun&) {
      return false;
    }
  };
  CAPTURE(scheme, viscosity);
  CHECK(ends_well("0.98"));
  CHECK_FALSE(ends_well("1.03"));
}
