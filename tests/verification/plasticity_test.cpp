// Elastoplasticity with linear hardening: the wave of two fronts, unloading, and its balance of energy.
#include <algorithm>
#include <cmath>
#include <string>

#include <hompm/scene/amplitude.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace {

constexpr double elastic_speed = 10.0;  // √(E/ρ)
constexpr double plastic_speed = 5.0;   // √(E_t/ρ), E_t = E/4
constexpr double yield = 100.0;

std::string text(const std::string& scheme, const std::string& load, double end_time) {
  return "end_time = " + std::to_string(end_time) + R"(
body.length = 1
material = { law = "elastoplastic", density = 1000, youngs_modulus = 1e5, yield_stress = 100, tangent_modulus = 25e3 }
ends.right = "free"
effect = [ { type = "traction", value = )" +
         load + R"( } ]
scheme = { name = ")" +
         scheme + R"(", cells = 64, particles_per_cell = 4, step_fraction = 0.05 })";
}

/// A load that grows sends each level of stress on its own way: levels up to the yield stress with the
/// elastic speed, those above with the plastic one.
double exact_stress(double way, double time, double load, const hompm::Amplitude& amplitude) {
  const auto loaded = [&](double speed) {
    return time > way / speed ? load * amplitude(time - way / speed) : 0.0;
  };
  return std::max(std::min(loaded(elastic_speed), yield),
                  loaded(plastic_speed) > yield ? loaded(plastic_speed) : 0.0);
}

/// Mean distance from the exact stress over the load.
double error(const std::string& scheme, const hompm::Amplitude& amplitude, const std::string& cells) {
  const auto of =
      hompm::parse_scene(text(scheme, "300, ramp_time = " + std::to_string(amplitude.ramp_time), 0.09),
                         "plasticity test", {{"scheme.cells", cells, "--cells"}});
  const auto result = hompm::run(of, hompm::time_stepping(of));
  CHECK(result.end.dissipated > 0.1 * result.end.external_work);
  CHECK(result.largest_residual < 2e-2 * result.end.external_work);
  double sum = 0.0;
  for (std::size_t i = 0; i < result.final.size(); ++i)
    sum += std::abs(result.final.stress[i] -
                    exact_stress(1.0 - result.final.reference_position[i], 0.09, 300.0, amplitude));
  return sum / 300.0 / static_cast<double>(result.final.size());
}

}  // namespace

TEST_CASE("a load beyond the yield stress sends a wave of two fronts") {
  const std::string scheme =
      GENERATE(as<std::string>{}, "bspline", "tielen2017", "high-order", "bspline\", sequence = \"usf",
               "bspline\", sequence = \"usl", "bspline\", stress_update = \"from-stretch");
  CAPTURE(scheme);
  // Kinks of the exact solution leave order 3/2 and more to a smooth load, fronts 1/2 and more to a jump.
  const hompm::Amplitude smooth{.ramp_time = 0.05};
  const hompm::Amplitude jump;
  CHECK(error(scheme, smooth, "128") < 0.16 * error(scheme, smooth, "32"));
  CHECK(error(scheme, smooth, "128") < 0.01);
  CHECK(error(scheme, jump, "128") < 0.5 * error(scheme, jump, "32"));
  CHECK(error(scheme, jump, "128") < 0.05);
}

TEST_CASE("the two fronts run with the elastic and the plastic wave speed") {
  const auto of =
      hompm::parse_scene(text("high-order", "300", 0.09), "plasticity test",
                         {{"scheme.cells", "128", "--cells"}, {"output.snapshots", "2", "--snapshots"}});
  std::vector<hompm::Snapshot> snapshots;
  hompm::RunObserver observer;
  observer.snapshot = [&](const hompm::Snapshot& s) { snapshots.push_back(s); };
  hompm::run(of, hompm::time_stepping(of), observer);
  const auto way = [](const hompm::Snapshot& s, double stress) {
    std::size_t i = 0;
    while (s.stress[i] < stress) ++i;
    return 1.0 - s.reference_position[i];
  };
  const double seconds = snapshots[2].time - snapshots[1].time;
  const auto speed = [&](double stress) {
    return (way(snapshots[2], stress) - way(snapshots[1], stress)) / seconds;
  };
  CHECK(std::abs(speed(50.0) / elastic_speed - 1.0) < 0.02);  // a particle's spacing of the way: 1 %
  CHECK(std::abs(speed(200.0) / plastic_speed - 1.0) < 0.02);
}

TEST_CASE("yielding follows the kinematic hardening to the rounding of a return") {
  const bool increments = GENERATE(true, false);
  const auto of =
      hompm::parse_scene(text(increments ? "bspline" : "high-order", "0", 0.1), "plasticity test", {});
  hompm::Simulation simulation(of, 1e-4);
  auto& particles = simulation.state().particles;
  const auto strained = [&](double strain) {  // from the strain before, all of it in one step
    const double before = particles.stretch[5] - 1.0;
    particles.stretch[5] = 1.0 + strain;
    particles.stress[5] = increments ? particles.stress[5] + 1e5 * (strain - before) : 1e5 * strain;
    simulation.plan()[hompm::Phase::motion].back().run(simulation.state());
    return particles.stress[5];
  };
  // With strains in powers of two only the returns round.
  const auto near = [](double stress, double expected) { return std::abs(stress - expected) < 1e-12; };
  constexpr double e = 0x1p-10;  // E e = 97.65625, just below the yield stress
  CHECK(strained(0.5 * e) == 48.828125);
  CHECK(near(strained(2.0 * e), 123.828125));    // 100 + E_t (2 e − 1e-3)
  CHECK(near(strained(e), 26.171875));           // unloads elastically
  CHECK(near(strained(2.0 * e), 123.828125));    // and loads again
  CHECK(near(strained(0.0), -71.484375));        // the elastic range has kept its width of 200
  CHECK(near(strained(-2.0 * e), -123.828125));  // yields the other way, on the line through −100 at −1e-3
}
