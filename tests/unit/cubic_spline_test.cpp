// Properties of the interpolating cubic splines.
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <Eigen/Dense>

#include <hompm/error.hpp>
#include <hompm/numerics/cubic_spline.hpp>
#include <hompm/numerics/elementary.hpp>

#include "support/catch.hpp"

using hompm::numerics::CubicSplineSites;

namespace {

/// Sites with spacings that vary by 3 : 1.
std::vector<double> uneven_sites(std::size_t count) {
  std::vector<double> x(count);
  double at = -0.7;
  for (std::size_t i = 0; i < count; ++i) {
    x[i] = at;
    at += 0.1 * (2.0 + hompm::numerics::sin(3.0 * static_cast<double>(i)));
  }
  return x;
}

struct Spline {
  CubicSplineSites sites;
  std::vector<double> y;
  CubicSplineSites::Fit fit;
  Spline(const std::vector<double>& x, std::vector<double> values)
      : sites(x.size()), y(std::move(values)), fit(x.size()) {
    REQUIRE(sites.factorise(x) == 0);
    sites.fit(y, fit);
  }
  [[nodiscard]] double operator()(double x) const { return sites.evaluate(sites.weights(x, 0), fit); }
};

}  // namespace

TEST_CASE("cubics are reproduced, between and beyond the sites") {
  const std::size_t count = GENERATE(4u, 5u, 6u, 7u, 20u);
  const auto f = [](double x) { return 1.0 - 2.0 * x + 0.5 * x * x + 0.75 * x * x * x; };
  const auto x = uneven_sites(count);
  std::vector<double> y;
  for (const double site : x) y.push_back(f(site));
  const Spline spline(x, y);
  for (double at = x.front() - 0.05; at < x.back() + 0.05; at += 0.013)
    CHECK(std::abs(spline(at) - f(at)) <
          1e-13 * std::max(1.0, std::abs(f(x.back()))));  // condition ~ 1e2, eps 2e-16
}

TEST_CASE("the slope at a site is that of the cubic") {
  const auto x = uneven_sites(9);
  std::vector<double> y;
  for (const double site : x) y.push_back(site * (2.0 + site * (1.0 - site)));
  const Spline spline(x, y);
  for (std::size_t i = 0; i < x.size(); ++i)
    CHECK(std::abs(spline.sites.slope(i, spline.fit) - (2.0 + 2.0 * x[i] - 3.0 * x[i] * x[i])) < 1e-12);
}

TEST_CASE("few sites give the straight line and the parabola") {
  const Spline line({0.0, 2.0}, {1.0, 5.0});
  CHECK(line(0.5) == 2.0);
  CHECK(line(3.0) == 7.0);
  const Spline parabola({0.0, 1.0, 3.0}, {0.0, 1.0, 9.0});
  CHECK(std::abs(parabola(2.0) - 4.0) < 1e-14);
  CHECK(std::abs(parabola(-1.0) - 1.0) < 1e-14);
  CHECK_THROWS_AS(CubicSplineSites(1), hompm::Error);
}

TEST_CASE("the spline passes through its data and agrees with a dense solve of the not-a-knot conditions") {
  const std::size_t n = 12;
  const auto x = uneven_sites(n);
  std::vector<double> y;
  for (const double site : x) y.push_back(hompm::numerics::sin(5.0 * site));
  const Spline spline(x, y);
  for (std::size_t i = 0; i < n; ++i) CHECK(std::abs(spline(x[i]) - y[i]) < 1e-15 * 8);

  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
  const auto h = [&](std::size_t i) { return x[i + 1] - x[i]; };
  const auto entry = [&](std::size_t i, std::size_t j) -> double& {
    return a(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  };
  for (std::size_t i = 1; i + 1 < n; ++i) {
    entry(i, i - 1) = h(i - 1);
    entry(i, i) = 2.0 * (h(i - 1) + h(i));
    entry(i, i + 1) = h(i);
    b(static_cast<Eigen::Index>(i)) = 6.0 * ((y[i + 1] - y[i]) / h(i) - (y[i] - y[i - 1]) / h(i - 1));
  }
  // the third derivative is continuous at the second and the last but one site
  entry(0, 0) = h(1), entry(0, 1) = -(h(0) + h(1)), entry(0, 2) = h(0);
  entry(n - 1, n - 3) = h(n - 2), entry(n - 1, n - 2) = -(h(n - 3) + h(n - 2)),
                   entry(n - 1, n - 1) = h(n - 3);
  const Eigen::VectorXd m = a.fullPivLu().solve(b);
  for (std::size_t i = 0; i < n; ++i)
    CHECK(std::abs(spline.fit.second_derivatives[i] - m(static_cast<Eigen::Index>(i))) <
          1e-11 * m.cwiseAbs().maxCoeff());
}

TEST_CASE("interpolation of a smooth function is of fourth order") {
  const auto error = [](std::size_t n) {
    std::vector<double> x(n + 1), y(n + 1);
    for (std::size_t i = 0; i <= n; ++i) {
      x[i] = static_cast<double>(i) / static_cast<double>(n);
      y[i] = hompm::numerics::sin_pi(x[i]);
    }
    const Spline spline(x, y);
    double worst = 0.0;
    for (int k = 0; k <= 1000; ++k)
      worst = std::max(worst, std::abs(spline(k / 1000.0) - hompm::numerics::sin_pi(k / 1000.0)));
    return worst;
  };
  CHECK(error(20) / error(40) > 14.0);
}

TEST_CASE("sites that do not ascend are found") {
  CubicSplineSites sites(4);
  CHECK(sites.factorise(std::vector{0.0, 1.0, 1.0, 2.0}) == 2);
  CHECK(sites.factorise(std::vector{0.0, 1.0, 0.5, 2.0}) == 2);
  CHECK(sites.factorise(std::vector{0.0, 1.0, 2.0, std::numeric_limits<double>::quiet_NaN()}) == 3);
  CHECK(sites.factorise(std::vector{0.0, 1.0, 2.0, 3.0}) == 0);
}
