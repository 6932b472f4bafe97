#include <algorithm>
#include <cmath>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/reference/characteristics.hpp>
#include <hompm/reference/method_of_lines.hpp>

#include "support/catch.hpp"

namespace {

using namespace hompm;

const GasColumn column{1.0, 1000.0, 10.0, -9.81};

std::vector<double> points(int n) {
  std::vector<double> X;
  for (int i = 0; i < n; ++i) X.push_back((i + 0.5) / n);
  return X;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

}  // namespace

TEST_CASE("until the wave reaches the free end the column is an exact simple wave", "[characteristics]") {
  // The base, seen by the falling observer, moves with w = −bτ; w is constant along X = c e^(w/c) (t − τ),
  // and the density is 1/λ = e^(w/c). Points are chosen by τ.
  const double time = 0.09, c = 10.0, b = -9.81;
  std::vector<double> X, v, stress;
  for (double tau = 0.089; tau >= 0.0; tau -= 0.001) {
    const double w = -b * tau;
    X.push_back(c * std::exp(w / c) * (time - tau));
    v.push_back(w + b * time);
    stress.push_back(1e5 * (1.0 - std::exp(w / c)));
  }
  X.insert(X.end(), {0.95, 1.0});  // not yet reached
  v.insert(v.end(), 2, b * time);
  stress.insert(stress.end(), 2, 0.0);
  const ReferenceFields fields = gas_column(column, 32).at(time, X);
  CHECK(largest_difference(fields.velocity, v) < 1e-12);
  CHECK(largest_difference(fields.stress, stress) < 1e-7);  // 1e-12 E
  CHECK(std::abs(fields.displacement.back() - 0.5 * b * time * time) < 1e-15);
}

TEST_CASE("displacement, velocity and stress of the column belong together", "[characteristics]") {
  // λ = 1 + ∂u/∂X and v = ∂u/∂t by central differences: error h² times a third derivative, rounding 1e-15/h.
  const double h = 1e-5;
  const FieldsAt at = gas_column(column, 32).at;
  for (const double time : {0.06, 0.25, 0.61, 2.4}) {
    const std::vector<double> X{0.1, 0.37, 0.85};
    const auto before = at(time - h / 10.0, X);
    const auto now = at(time, std::vector<double>{X[0] - h, X[0], X[0] + h, X[1] - h, X[1], X[1] + h,
                                                  X[2] - h, X[2], X[2] + h});
    const auto after = at(time + h / 10.0, X);
    for (std::size_t i = 0; i < X.size(); ++i) {
      INFO("t = " << time << ", X = " << X[i]);
      const double stretch = 1.0 + (now.displacement[3 * i + 2] - now.displacement[3 * i]) / (2.0 * h);
      CHECK(std::abs(now.stress[3 * i + 1] / 1e5 - (1.0 - 1.0 / stretch)) < 1e-8);
      const double velocity = (after.displacement[i] - before.displacement[i]) / (0.2 * h);
      CHECK(std::abs(now.velocity[3 * i + 1] - velocity) < 1e-7);
    }
  }
  const ReferenceFields ends = at(2.5, std::vector<double>{0.0, 1.0});
  CHECK(std::abs(ends.displacement[0]) < 1e-12);
  CHECK(std::abs(ends.velocity[0]) < 1e-11);
  CHECK(std::abs(ends.stress[1]) < 1e-7);
}

TEST_CASE("the net converges with high order", "[characteristics]") {
  const std::vector<double> X = points(100);
  const auto at = [&](int curves) { return gas_column(column, curves).at(0.5, X).displacement; };
  const std::vector<double> exact = at(48);
  const double coarse = largest_difference(at(8), exact);
  const double fine = largest_difference(at(16), exact);
  CHECK(fine < 1e-12);
  CHECK(coarse / fine > 64.0);  // order 6 at the least; rounding is near
}

TEST_CASE("the method of lines tends to the net", "[characteristics]") {
  Scene scene;
  scene.body.length = 1.0;
  scene.material = {"rate", 1000.0, 1e5};
  scene.ends.right = End::free;
  Loads loads;
  loads.gravity = {{.value = -9.81}};
  const std::vector<double> X = points(100);
  const ReferenceFields exact = gas_column(column, 32).at(0.5, X);
  const auto error = [&](int elements) {
    return largest_difference(method_of_lines(scene, loads, {elements, 4, 1.0})(0.5, X).displacement,
                              exact.displacement);
  };
  const double coarse = error(25);
  const double fine = error(50);
  CHECK(fine < 1e-6);
  CHECK(coarse / fine > 2.5);  // the kink leaves second order
}

TEST_CASE("a shock ends the smooth solution of the column", "[characteristics]") {
  const GasColumn soft{1.0, 1000.0, std::sqrt(10.0), -9.81};
  const std::vector<double> X = points(5);
  const FieldsAt at = gas_column(soft, 32).at;
  at(0.5, X);
  CHECK_THROWS_AS(at(0.4, X), Error);
  CHECK_THROWS_AS(at(5.0, X), Error);
  CHECK_THROWS_AS(at(5.0, X), Error);
}
