#include <cmath>

#include <hompm/error.hpp>
#include <hompm/numerics/gauss_legendre.hpp>

#include "support/catch.hpp"

using hompm::numerics::gauss_legendre;

TEST_CASE("n Gauss points integrate polynomials up to degree 2n - 1, and no further") {
  const int n = GENERATE(1, 2, 3, 4, 5, 8, 16);
  const auto rule = gauss_legendre(n);
  const auto integral = [&](int degree) {
    double sum = 0.0;
    for (std::size_t g = 0; g < rule.points.size(); ++g) {
      double power = 1.0;
      for (int k = 0; k < degree; ++k) power *= rule.points[g];
      sum += rule.weights[g] * power;
    }
    return sum;
  };
  for (int degree = 0; degree < 2 * n; ++degree)
    CHECK(std::abs(integral(degree) - 1.0 / (degree + 1)) < 4e-16 * n);  // sum of n positive terms below 1
  if (n < 8) CHECK(std::abs(integral(2 * n) - 1.0 / (2 * n + 1)) > 1e-12);
}

TEST_CASE("Gauss points are symmetric, ascending and inside") {
  const int n = GENERATE(1, 2, 3, 7, 10);
  const auto rule = gauss_legendre(n);
  for (std::size_t g = 0; g < rule.points.size(); ++g) {
    CHECK(rule.points[g] > (g > 0 ? rule.points[g - 1] : 0.0));
    CHECK(std::abs(rule.points[g] + rule.points[rule.points.size() - 1 - g] - 1.0) < 4e-16);
  }
  CHECK_THROWS_AS(gauss_legendre(0), hompm::Error);
}
