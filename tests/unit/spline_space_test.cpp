// Properties of the B-spline space, for every degree.
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/numerics/spline_space.hpp>

#include "support/catch.hpp"

using hompm::numerics::SplineSpace;

namespace {

struct Basis {
  std::array<double, 6> values{};
  std::array<double, 6> gradients{};
};

Basis evaluate(const SplineSpace& space, SplineSpace::Location at) {
  Basis basis;
  space.evaluate(at, basis.values, basis.gradients);
  return basis;
}

/// Cox–de Boor, written independently of the library: value of function i of degree k at x, knots clamped.
double cox_de_boor(int p, int cells, int i, int k, double x) {
  const auto knot = [&](int j) { return static_cast<double>(std::min(std::max(j - p, 0), cells)); };
  if (k == 0) return knot(i) <= x && x < knot(i + 1) ? 1.0 : 0.0;
  double value = 0.0;
  if (knot(i + k) > knot(i))
    value += (x - knot(i)) / (knot(i + k) - knot(i)) * cox_de_boor(p, cells, i, k - 1, x);
  if (knot(i + k + 1) > knot(i + 1))
    value += (knot(i + k + 1) - x) / (knot(i + k + 1) - knot(i + 1)) * cox_de_boor(p, cells, i + 1, k - 1, x);
  return value;
}

// A value of the basis is a polynomial of degree ≤ 5 with coefficients below 40 on [0, 1]: its rounding error
// stays below 64 units in the last place of 1.
constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();

}  // namespace

TEST_CASE("the basis is a partition of unity with gradients that sum to zero") {
  const int p = GENERATE(1, 2, 3, 4, 5);
  const int cells = GENERATE(1, 2, 3, 4, 5, 9, 10, 17);
  const SplineSpace space(p, cells, -1.0, 0.25);
  for (int cell = 0; cell < cells; ++cell) {
    for (const double s : {0.0, 0.1, 0.5, 0.875, 1.0}) {
      const Basis b = evaluate(space, {cell, s});
      double sum = 0.0;
      double slope = 0.0;
      for (std::size_t k = 0; k < 6; ++k) {
        CHECK(b.values[k] >= -rounding);
        sum += b.values[k];
        slope += b.gradients[k];
      }
      CHECK(std::abs(sum - 1.0) <= rounding);
      CHECK(std::abs(slope) <= rounding / 0.25 * p);
    }
  }
}

TEST_CASE("the basis agrees with the Cox-de Boor recursion") {
  const int p = GENERATE(1, 2, 3, 4, 5);
  const int cells = GENERATE(1, 3, 8, 13);
  const SplineSpace space(p, cells, 0.0, 1.0);
  for (int cell = 0; cell < cells; ++cell) {
    for (const double s : {0.0, 0.25, 0.625, 0.96875}) {
      const Basis b = evaluate(space, {cell, s});
      for (int k = 0; k <= p; ++k)
        CHECK(std::abs(b.values[static_cast<std::size_t>(k)] -
                       cox_de_boor(p, cells, cell + k, p, cell + s)) <= rounding);
    }
  }
}

TEST_CASE("gradients are the derivatives of the values") {
  const int p = GENERATE(1, 2, 3, 4, 5);
  const SplineSpace space(p, 12, 2.0, 0.5);
  const double d = 1e-5;  // central difference: error d² f'''/6 < 1e-8 here, rounding 1e-16/d
  for (int cell = 0; cell < 12; ++cell) {
    const Basis b = evaluate(space, {cell, 0.3});
    const Basis after = evaluate(space, {cell, 0.3 + d});
    const Basis before = evaluate(space, {cell, 0.3 - d});
    for (std::size_t k = 0; k < 6; ++k)
      CHECK(std::abs(b.gradients[k] - (after.values[k] - before.values[k]) / (2.0 * d * 0.5)) < 1e-7);
  }
}

TEST_CASE("splines of degree p are p - 1 times continuous: values and slopes agree across breakpoints") {
  const int p = GENERATE(2, 3, 4, 5);
  const int cells = 9;
  const SplineSpace space(p, cells, 0.0, 1.0);
  for (int cell = 0; cell + 1 < cells; ++cell) {
    const Basis left = evaluate(space, {cell, 1.0});
    const Basis right = evaluate(space, {cell + 1, 0.0});
    CHECK(std::abs(left.values[0]) <= rounding);
    for (std::size_t k = 0; k + 1 < 6; ++k) {
      CHECK(std::abs(left.values[k + 1] - right.values[k]) <= rounding);
      CHECK(std::abs(left.gradients[k + 1] - right.gradients[k]) <= 4 * rounding);
    }
  }
}

TEST_CASE("a linear field is reproduced with its gradient") {
  const int p = GENERATE(1, 2, 3, 4, 5);
  const int cells = 11;
  const SplineSpace space(p, cells, -3.0, 0.5);
  // Greville abscissae: the coefficients of x are the means of p consecutive inner knots.
  std::vector<double> coefficient;
  for (int i = 0; i < space.functions(); ++i) {
    double sum = 0.0;
    for (int j = i + 1; j <= i + p; ++j) sum += space.breakpoint(std::min(std::max(j - p, 0), cells));
    coefficient.push_back(sum / p);
  }
  for (const double x : {-3.0, -2.9, -1.77, 0.1, 2.2, 2.5}) {
    const auto at = space.locate(x);
    const Basis b = evaluate(space, at);
    double value = 0.0;
    double slope = 0.0;
    for (int k = 0; k <= p; ++k) {
      value += b.values[static_cast<std::size_t>(k)] * coefficient[static_cast<std::size_t>(at.cell + k)];
      slope += b.gradients[static_cast<std::size_t>(k)] * coefficient[static_cast<std::size_t>(at.cell + k)];
    }
    CHECK(std::abs(value - x) <= 4 * rounding);
    CHECK(std::abs(slope - 1.0) <=
          32 * rounding);  // gradients are 1/h times a sum of cancelling terms up to |x| = 3
  }
}

TEST_CASE("the boundary functions are 1 at the ends of the grid") {
  const int p = GENERATE(1, 2, 3, 4, 5);
  const SplineSpace space(p, 7, 1.0, 0.125);
  CHECK(evaluate(space, space.locate(1.0)).values[0] == 1.0);
  const auto end = space.locate(1.0 + 7 * 0.125);
  CHECK(end.cell == 6);
  CHECK(std::abs(evaluate(space, end).values[static_cast<std::size_t>(p)] - 1.0) <= rounding);
}

TEST_CASE("functions that vanish at a breakpoint keep all their digits near it, on both sides") {
  const int p = GENERATE(1, 2, 3, 4, 5);
  const SplineSpace space(p, 16, 0.0, 1.0);
  double factorial = 1.0;
  for (int k = 2; k <= p; ++k) factorial *= k;
  for (const double distance : {0.25, 0x1p-10, 0x1p-30, 0x1p-50}) {
    double expected = 1.0 / factorial;
    for (int k = 0; k < p; ++k) expected *= distance;
    const double starting = evaluate(space, {8, distance}).values[static_cast<std::size_t>(p)];
    const double ending = evaluate(space, {8, 1.0 - distance}).values[0];
    CHECK(std::abs(starting - expected) <= 8 * std::numeric_limits<double>::epsilon() * expected);
    CHECK(std::abs(ending - expected) <= 8 * std::numeric_limits<double>::epsilon() * expected);
  }
}

TEST_CASE("positions outside the grid, and no numbers, are not located") {
  const SplineSpace space(2, 4, 0.0, 0.25);
  CHECK(space.locate(-1e-300).cell == -1);
  CHECK(space.locate(std::nextafter(1.0, 2.0)).cell == -1);
  CHECK(space.locate(std::numeric_limits<double>::quiet_NaN()).cell == -1);
  CHECK(space.locate(std::numeric_limits<double>::infinity()).cell == -1);
  CHECK(space.locate(0.25).cell == 1);
  CHECK(space.locate(0.25).s == 0.0);
}

TEST_CASE("a spline space refuses what it cannot be") {
  CHECK_THROWS_AS(SplineSpace(0, 4, 0.0, 1.0), hompm::Error);
  CHECK_THROWS_AS(SplineSpace(6, 4, 0.0, 1.0), hompm::Error);
  CHECK_THROWS_AS(SplineSpace(2, 0, 0.0, 1.0), hompm::Error);
  CHECK_THROWS_AS(SplineSpace(2, 4, 0.0, 0.0), hompm::Error);
  CHECK_THROWS_AS(SplineSpace(2, 4, 0.0, std::numeric_limits<double>::quiet_NaN()), hompm::Error);
}
