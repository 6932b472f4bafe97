// What has no reference solution in the library against its closed form: local damping, damping transfers,
// sudden gravity, what an absorbing end and an interface of materials reflect; each at the order of its
// scheme.
#include <cmath>
#include <string>
#include <vector>

#include <hompm/kit/verify/judge.hpp>
#include <hompm/numerics/elementary.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace {

using hompm::numerics::pi;
using hompm::numerics::sin_pi;

hompm::RunResult run(const hompm::Scene& scene) { return hompm::run(scene, hompm::time_stepping(scene)); }

/// A bar between fixed ends in its first mode, of the angular frequency 10π.
hompm::Scene vibrating(const std::string& effect, const std::string& scheme) {
  return hompm::parse_scene(R"(
end_time = 0.23
body.length = 1
material = { law = "linear", density = 1000, youngs_modulus = 1e5 }
initial.velocity = { shape = "sine", amplitude = 1e-3 }
effect = [ )" + effect + R"( ]
scheme = { particles_per_cell = 4, )" +
                                scheme + " }",
                            "closed forms", {});
}

hompm::Scene example(const std::string& name, const std::string& scheme, const std::string& cells,
                     std::vector<hompm::Override> more = {}) {
  more.push_back({"scheme.name", scheme, "--scheme"});
  more.push_back({"scheme.cells", cells, "--cells"});
  return hompm::load_scene(HOMPM_SOURCE_DIR "/docs/scenes/" + name + ".toml", more);
}

/// The displacement of the mode over V sin(πX): local damping makes the force 1 + α times as large on the way
/// out, and 1 − α times on the way back.
double locally_damped(double time, double coefficient) {
  const double omega = 10.0 * pi;
  double sign = 1.0;
  double speed = 1.0;  // at u = 0
  for (;;) {
    const double out = omega * std::sqrt(1.0 + coefficient);
    const double back = omega * std::sqrt(1.0 - coefficient);
    if (time < 0.5 * pi / out) return sign * speed / out * std::sin(out * time);
    time -= 0.5 * pi / out;
    if (time < 0.5 * pi / back) return sign * speed / out * std::cos(back * time);
    time -= 0.5 * pi / back;
    speed *= back / out;
    sign = -sign;
  }
}

}  // namespace

TEST_CASE("local damping: a mode swings out faster than it comes back, at the order of the scheme") {
  const std::string scheme = GENERATE(as<std::string>{}, "bspline", "tielen2017", "high-order");
  const double coefficient = GENERATE(0.1, 0.3);
  const auto error = [&](int cells) {
    const auto result =
        run(vibrating(R"({ type = "local-damping", coefficient = )" + std::to_string(coefficient) + " }",
                      "name = \"" + scheme + "\", time_step = 1e-5, cells = " + std::to_string(cells)));
    const double amplitude = 1e-3 * locally_damped(0.23, coefficient);
    double difference = 0.0, size = 0.0;
    for (std::size_t i = 0; i < result.final.size(); ++i) {
      const double exact = amplitude * sin_pi(result.final.reference_position[i]);
      difference += std::pow(result.final.displacement[i] - exact, 2);
      size += exact * exact;
    }
    return std::sqrt(difference / size);
  };
  const double coarse = error(16);
  const double fine = error(32);
  CAPTURE(scheme, coefficient, coarse, fine);
  // The force changes by a jump, four times here and each time up to a step too late: Δt/(a quarter of the
  // period) is 2e-4, which is all that high-order leaves. The others are of second order.
  if (scheme == "high-order") {
    CHECK(fine < 1.6e-3 * coefficient);
  } else {
    CHECK(std::log2(coarse / fine) > 1.9);
    CHECK(fine < 0.03);
  }
}

TEST_CASE("a transfer takes from a mode what its projection does not keep of it, at second order") {
  struct Case {
    std::string scheme, transfer;
    double power;     ///< of 1 − m in what a step takes
    double fraction;  ///< of that in what particles take back
    double order, error;
  };
  // What the fixed ends do to the functions beside them keeps the splines below second order.
  const auto& c =
      GENERATE(values<Case>({{"classical", "flip_fraction = 0.9", 1.0, 0.1, 1.9, 2e-3},
                             {"classical", "transfer = \"xpic\", xpic_order = 2", 2.0, 1.0, 1.9, 2e-3},
                             {"bspline", "flip_fraction = 0.9", 1.0, 0.1, 1.5, 1e-2}}));
  const auto error = [&](int cells) {
    const double kh = pi / cells;
    // What lumped mass leaves of sin(kX), with four particles in a cell.
    const double kept = c.scheme == "classical" ? 1.0 - 11.0 / 32.0 * (1.0 - std::cos(kh))
                                                : (33.0 + 26.0 * std::cos(kh) + std::cos(2.0 * kh)) / 60.0;
    constexpr double time_step = 1e-4;
    const double rate = c.fraction * std::pow(1.0 - kept, c.power) / (2.0 * time_step);
    auto scene = vibrating("", "time_step = 1e-4, name = \"" + c.scheme +
                                   "\", cells = " + std::to_string(cells) + ", " + c.transfer);
    scene.end_time = 0.2;  // whole periods: what is lost comes and goes with the kinetic energy
    const auto result = run(scene);
    const double lost = 1.0 - std::exp(-2.0 * rate * scene.end_time);
    return std::abs(result.end.dissipated / result.start.kinetic / lost - 1.0);
  };
  const double coarse = error(16);
  const double fine = error(32);
  CAPTURE(c.scheme, c.transfer, coarse, fine);
  CHECK(std::log2(coarse / fine) > c.order);
  CHECK(fine < c.error);
}

TEST_CASE("gravity that acts at once is followed at the order that its kinks allow") {
  // The stress has kinks, the displacement jumps in its second derivative: orders 3/2 q/(q + 1) and
  // 5/2 q/(q + 1) with waves of order q (Peetre, Thomee 1967), 2 with lumped mass, 6 of high-order.
  const std::string scheme = GENERATE(as<std::string>{}, "bspline", "tielen2017", "high-order");
  const auto errors = [&](int cells) {
    const auto scene = hompm::parse_scene(R"(
end_time = 0.25
body.length = 1
material = { law = "linear", density = 1000, youngs_modulus = 1e5 }
ends.right = "free"
effect = [ { type = "gravity", acceleration = -9.81 } ]
scheme = { time_step = 1e-5, particles_per_cell = 4, name = ")" +
                                              scheme + "\", cells = " + std::to_string(cells) + " }",
                                          "sudden gravity", {});
    std::string reason;
    const auto report = hompm::judge(scene, run(scene), reason);
    REQUIRE(report);
    return *report;
  };
  const auto coarse = errors(16);
  const auto fine = errors(64);
  const double of_waves = scheme == "high-order" ? 6.0 / 7.0 : 2.0 / 3.0;
  const double displacement =
      std::log2(coarse.displacement.relative_l2 / fine.displacement.relative_l2) / 2.0;
  const double stress = std::log2(coarse.stress.relative_l2 / fine.stress.relative_l2) / 2.0;
  CAPTURE(scheme, displacement, stress);
  CHECK(displacement > 2.5 * of_waves - 0.1);
  CHECK(stress > 1.5 * of_waves - 0.1);
  CHECK(fine.displacement.relative_l2 < (scheme == "high-order" ? 1e-5 : 1e-3));
}

TEST_CASE("an absorbing end reflects what the scheme's order leaves") {
  // Energy goes with the square of the amplitude. The end of schemes without markers is drawn on from two
  // particles, first order; leapfrog of high-order is of second order.
  const std::string scheme = GENERATE(as<std::string>{}, "bspline", "tielen2017", "high-order");
  const auto reflected = [&](const std::string& cells) {
    const auto result = run(example("absorbing", scheme, cells));
    return (result.end.kinetic + result.end.stored) / result.end.external_work;
  };
  const double coarse = reflected("32");
  const double fine = reflected("64");
  CAPTURE(scheme, coarse, fine);
  CHECK(std::log2(coarse / fine) > (scheme == "high-order" ? 4.0 : 2.0));
  CHECK(fine < 0.01);
}

TEST_CASE("an interface reflects and transmits by the impedances, at the order of the scheme") {
  // Impedances 1 and 2: −1/3 of the momentum comes back, 4/3 of it go on. Orders as with the absorbing end,
  // of amplitudes.
  const std::string scheme = GENERATE(as<std::string>{}, "bspline", "tielen2017", "high-order");
  const auto error = [&](const std::string& cells) {
    const auto result = run(example("interface", scheme, cells,
                                    {{"body[0].cells", cells, "--set"}, {"body[1].cells", cells, "--set"}}));
    double momentum = 0.0;
    for (std::size_t i = 0; i < result.final.size(); ++i)
      if (result.final.body[i] == 0)
        momentum += result.final.density[i] * result.final.volume[i] * result.final.velocity[i];
    return std::abs(momentum / 0.02 + 1.0 / 3.0);
  };
  const double coarse = error("32");
  const double fine = error("128");
  CAPTURE(scheme, coarse, fine);
  CHECK(std::log2(coarse / fine) / 2.0 > (scheme == "high-order" ? 2.0 : 1.0));
  CHECK(fine < (scheme == "high-order" ? 1e-8 : 2e-3));
}
