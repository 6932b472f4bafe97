// The manufactured solution: the order of each scheme in displacement and stress, with any law.
#include <cmath>
#include <string>

#include <hompm/kit/verify/judge.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace {

hompm::Scene bar(const std::string& law, const std::string& scheme, int cells, const std::string& amplitude) {
  return hompm::parse_scene(R"(
end_time = 0.13
body.length = 1
material = { law = ")" + law + R"(", density = 1000, youngs_modulus = 1e5 }
effect = [ { type = "manufactured", amplitude = )" +
                                amplitude + R"( } ]
scheme = { )" + scheme + ", cells = " +
                                std::to_string(cells) + ", particles_per_cell = 4, step_fraction = 0.02 }",
                            "manufactured test", {});
}

hompm::ErrorReport errors(const hompm::Scene& scene) {
  const auto result = hompm::run(scene, hompm::time_stepping(scene));
  std::string reason;
  const auto report = hompm::judge(scene, result, reason);
  INFO(reason);
  REQUIRE(report);
  CHECK(report->reference_errors.displacement == 0.0);  // a closed form
  return *report;
}

struct Row {
  std::string scheme;
  std::string amplitude;
  int cells;                    ///< and twice as many
  double displacement, stress;  ///< orders, as measured less a margin
};

}  // namespace

TEST_CASE("the manufactured solution shows the order of each scheme in displacement and stress") {
  // Leapfrog is of second order, as the displacement of degree 4 shows at these steps. Hat functions and
  // particle quadrature keep their order only as long as no particle leaves its cell, momentum that is kept
  // cell by cell only as long as particles move little (docs/schemes.md).
  const Row row = GENERATE(
      Row{R"(name = "classical")", "1e-4", 16, 1.9, 0.9}, Row{R"(name = "bspline")", "1e-4", 16, 1.9, 1.6},
      Row{R"(name = "tielen2017")", "0.05", 16, 1.9, 1.9}, Row{R"(name = "mls")", "0.05", 16, 1.9, 1.9},
      Row{R"(name = "tls", conserve = "cell-momentum")", "1e-4", 16, 1.9, 1.9},
      Row{R"(name = "tls")", "0.05", 16, 1.9, 1.9}, Row{R"(name = "mixed")", "1e-4", 16, 1.9, 0.9},
      Row{R"(name = "mixed")", "0.05", 16, 1.8, 1.0},
      Row{R"(name = "high-order", degree = 2)", "0.05", 16, 2.9, 2.2},
      Row{R"(name = "high-order", degree = 3)", "0.05", 8, 3.8, 3.0},
      Row{R"(name = "high-order", degree = 4)", "0.05", 8, 2.0, 3.8});
  const auto coarse = errors(bar("neo-hookean", row.scheme, row.cells, row.amplitude));
  const auto fine = errors(bar("neo-hookean", row.scheme, 2 * row.cells, row.amplitude));
  CAPTURE(row.scheme);
  CHECK(std::log2(coarse.displacement.relative_l2 / fine.displacement.relative_l2) > row.displacement);
  CHECK(std::log2(coarse.stress.relative_l2 / fine.stress.relative_l2) > row.stress);
}

TEST_CASE("the manufactured body force is that of every law") {
  const std::string law = GENERATE(as<std::string>{}, "linear", "rate", "hencky", "neo-hookean");
  const auto scene = bar(law, R"(name = "high-order")", 16, "0.05");
  const auto report = errors(scene);
  CAPTURE(law);
  CHECK(report.displacement.relative_l2 < 2e-5);
  CHECK(report.stress.relative_l2 < 2e-4);
}

TEST_CASE("the work and the impulse of the manufactured body force are booked") {
  const auto scene = bar("hencky", R"(name = "high-order")", 32, "0.15");
  const auto result = hompm::run(scene, hompm::time_stepping(scene));
  CHECK(std::abs(result.end.external_work) > 0.01 * result.largest_energy);
  CHECK(result.largest_residual < 1e-5 * result.largest_energy);
  // O(h²), of the reconstructed density: docs/high-order.md
  CHECK(result.largest_momentum_residual < 1e-4 * result.largest_momentum);
}
