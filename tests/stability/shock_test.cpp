// The shock of the law `rate` against its exact speed and plateau: a bar that flies into a fixed end.
#include <cmath>
#include <string>

#include <hompm/simulation/run.hpp>

#include "stability/hard_cases.hpp"
#include "support/catch.hpp"

namespace {

/// E = ρ0 = 1, so c = 1. A bar at −V meets a fixed end: behind the shock it stands still, and the jump
/// conditions of the law σ = E (1 − 1/λ) give √λ = (−V + √(V² + 4))/2 there, and the speed 1/√λ in X.
struct Shock {
  explicit Shock(double impact) {
    const double root = 0.5 * (std::sqrt(impact * impact + 4.0) - impact);
    speed = 1.0 / root;
    stress = 1.0 - 1.0 / (root * root);
  }
  double speed, stress;
};

struct Outcome {
  double speed;    ///< relative error
  double plateau;  ///< relative error of the mean stress behind the shock
  double ripple;   ///< largest distance from it, relative
  double overall;  ///< ∫ |σ − exact| dX over −stress
};

/// Where the stress passes half the plateau, from the shock's side.
double front(const hompm::Snapshot& s, double half) {
  std::size_t i = s.size() - 1;
  while (i > 1 && s.stress[i - 1] > half) --i;
  const double part = (half - s.stress[i - 1]) / (s.stress[i] - s.stress[i - 1]);
  return s.reference_position[i - 1] + part * (s.reference_position[i] - s.reference_position[i - 1]);
}

Outcome impact(const std::string& scheme, int cells, double velocity, const std::string& fraction,
               bool with_viscosity = true) {
  const auto scene = hompm::test::hard("shock", {{"scheme.name", scheme},
                                                 {"scheme.cells", std::to_string(cells)},
                                                 {"scheme.step_fraction", fraction},
                                                 {"effect[0].quadratic", with_viscosity ? "2" : "0"},
                                                 {"effect[0].linear", with_viscosity ? "0.5" : "0"}});
  hompm::Simulation simulation(scene, hompm::time_stepping(scene).time_step);
  for (double& v : simulation.state().particles.velocity) v = -velocity;
  const Shock exact(velocity);
  const auto until = [&](double way) {  // run by the shock, of a bar of 1
    while (simulation.state().time < way / exact.speed) simulation.step();
    return simulation.snapshot(simulation.state().time);
  };
  const auto before = until(0.35);
  const auto after = until(0.75);
  const double speed =
      (front(after, 0.5 * exact.stress) - front(before, 0.5 * exact.stress)) / (after.time - before.time);
  Outcome outcome{
      .speed = std::abs(speed / exact.speed - 1.0), .plateau = 0.0, .ripple = 0.0, .overall = 0.0};
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    CHECK(after.density[i] > 0.0);
    const double X = after.reference_position[i];
    const double ratio = after.stress[i] / exact.stress;
    if (cells == 256 && velocity == 0.5) hompm::test::shown("shock-profile", scheme, X, after.stress[i]);
    outcome.overall +=
        std::abs(ratio - (X < exact.speed * after.time ? 1.0 : 0.0)) / static_cast<double>(after.size());
    if (X < 0.1 || X > 0.6) continue;  // what the start left at the wall; the shock itself
    outcome.ripple = hompm::test::larger(outcome.ripple, std::abs(ratio - 1.0));
    sum += ratio;
    ++count;
  }
  outcome.plateau = std::abs(sum / count - 1.0);
  return outcome;
}

}  // namespace

TEST_CASE("with bulk viscosity a shock has its exact speed and plateau, and converges") {
  const double velocity = GENERATE(0.1, 0.5);
  const std::string scheme = GENERATE(as<std::string>{}, "bspline", "tielen2017", "high-order");
  // The increments of the law add up to another one by O(Δt): nowhere as plain as in a shock.
  const std::string fraction = scheme == "high-order" ? "0.2" : "0.05";
  const Outcome coarse = impact(scheme, 64, velocity, fraction);
  const Outcome fine = impact(scheme, 256, velocity, fraction);
  CAPTURE(velocity, scheme, coarse.speed, fine.speed, coarse.plateau, fine.plateau, fine.ripple,
          coarse.overall, fine.overall);
  if (velocity == 0.5) {
    hompm::test::shown("shock", scheme, 0.0, fine.speed);
    hompm::test::shown("shock", scheme, 1.0, fine.plateau);
    hompm::test::shown("shock", scheme, 2.0, fine.ripple);
  }
  CHECK(fine.speed < 0.005);
  CHECK(fine.plateau < 0.005);
  // A shock of fixed width in cells: 1/4, and some more while a weak one is still widening.
  CHECK(fine.overall < 0.5 * coarse.overall);
  CHECK(fine.ripple < (scheme == "high-order" ? 0.002 : 0.04));
}

TEST_CASE("without bulk viscosity the same shock rings") {
  CHECK(impact("tielen2017", 64, 0.1, "0.05", false).ripple > 0.15);
}
