// Properties of the least-squares fits through data at scattered sites.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include <hompm/error.hpp>
#include <hompm/numerics/elementary.hpp>
#include <hompm/numerics/moving_least_squares.hpp>
#include <hompm/numerics/taylor_least_squares.hpp>

#include "support/catch.hpp"

using hompm::numerics::MovingLeastSquares;
using hompm::numerics::SplineSpace;
using hompm::numerics::TaylorLeastSquares;

namespace {

/// Sites from 0 on with spacings that vary by 3 : 1.
std::vector<double> uneven_sites(std::size_t count) {
  std::vector<double> x(count);
  double at = 0.05;
  for (std::size_t i = 0; i < count; ++i) {
    x[i] = at;
    at += 0.1 * (2.0 + hompm::numerics::sin(3.0 * static_cast<double>(i)));
  }
  return x;
}

template <class Function>
std::vector<double> values_at(const std::vector<double>& x, Function f) {
  std::vector<double> y;
  for (const double site : x) y.push_back(f(site));
  return y;
}

/// A value that depends on x without pattern.
double noise(double x) { return hompm::numerics::sin(1e4 * x); }

template <class Sites>
struct Fitted {
  Sites sites;
  std::vector<double> y;
  typename Sites::Fit fit;
  Fitted(Sites made, const std::vector<double>& x, std::vector<double> values)
      : sites(std::move(made)), y(std::move(values)), fit(x.size()) {
    REQUIRE(sites.factorise_and_fit(x, y, fit) == 0);
    sites.fit(y, fit);
  }
  [[nodiscard]] double operator()(double x) const { return sites.evaluate(sites.weights(x, 0), fit); }
};

Fitted<MovingLeastSquares> moving(const std::vector<double>& x, std::vector<double> values) {
  return {MovingLeastSquares(x.size()), x, std::move(values)};
}
Fitted<TaylorLeastSquares> taylor(const SplineSpace& grid, const std::vector<double>& x,
                                  std::vector<double> values) {
  return {TaylorLeastSquares(x.size(), grid), x, std::move(values)};
}

double parabola(double x) { return 1.0 - 2.0 * x + 0.5 * x * x; }
double line(double x) { return 1.0 - 2.0 * x; }

}  // namespace

TEST_CASE("moving least squares reproduce parabolas, between and beyond uneven sites") {
  const std::size_t count = GENERATE(3u, 4u, 6u, 7u, 8u, 30u);
  const auto x = uneven_sites(count);
  const auto fit = moving(x, values_at(x, parabola));
  for (double at = x.front() - 0.1; at < x.back() + 0.1; at += 0.013)
    CHECK(std::abs(fit(at) - parabola(at)) < 1e-13 * parabola(-x.back()));  // rounding of the largest value
}

TEST_CASE("two sites give moving least squares a line, one a constant, none an error") {
  const auto two = moving({0.5, 2.0}, {line(0.5), line(2.0)});
  CHECK(std::abs(two(-1.0) - line(-1.0)) < 1e-14);
  CHECK(moving({0.5}, {7.0})(3.0) == 7.0);
  CHECK_THROWS_AS(MovingLeastSquares(0), hompm::Error);
}

TEST_CASE("moving least squares are the weighted least squares of a dense solve") {
  // Six sites count; the cubic spline of the distance vanishes at the nearest of the others.
  const auto x = uneven_sites(20);
  const auto fit = moving(x, values_at(x, noise));
  for (const double at : {0.0, 0.06, 0.7, 1.33, 2.0, x[10], x.back() + 0.05}) {
    std::vector<double> distances;
    for (const double site : x) distances.push_back(std::abs(site - at));
    std::sort(distances.begin(), distances.end());
    const double radius = distances[6];
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(20, 3);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(20);
    for (Eigen::Index i = 0; i < 20; ++i) {
      const double d = x[static_cast<std::size_t>(i)] - at;
      const double s = std::abs(d) / radius;
      const double w = s < 0.5   ? 2.0 / 3.0 - 4.0 * s * s + 4.0 * s * s * s
                       : s < 1.0 ? 4.0 / 3.0 * std::pow(1.0 - s, 3)
                                 : 0.0;
      a.row(i) << std::sqrt(w), std::sqrt(w) * d, std::sqrt(w) * d * d;
      b(i) = std::sqrt(w) * fit.y[static_cast<std::size_t>(i)];
    }
    CHECK(std::abs(fit(at) - a.colPivHouseholderQr().solve(b)(0)) < 1e-12);  // condition 1e2, values of 1
  }
}

TEST_CASE("moving least squares are continuous where other sites begin to count") {
  const auto x = uneven_sites(20);
  const auto fit = moving(x, values_at(x, noise));
  for (std::size_t i = 0; i + 6 < x.size(); ++i) {
    const double change = 0.5 * (x[i] + x[i + 6]);
    CHECK(std::abs(fit(change + 1e-9) - fit(change - 1e-9)) < 1e-6);  // slopes are below 1e2
  }
}

TEST_CASE("Taylor least squares reproduce another parabola in each cell") {
  const SplineSpace grid(1, 8, 0.0, 0.75);
  const auto x = uneven_sites(27);
  const auto f = [&](double at) {
    const double cell = grid.locate(at).cell;
    return cell - (2.0 + cell) * at + (0.5 - cell) * at * at;
  };
  const auto fit = taylor(grid, x, values_at(x, f));
  for (double at = 0.001; at < 5.25; at += 0.013)
    CHECK(std::abs(fit(at) - f(at)) < 1e-12 * 200.0);  // rounding of 6.5 · 5.5², a condition of 1e2
}

TEST_CASE("the first Taylor coefficient is the mean over the cell, and all are those of a dense solve") {
  const SplineSpace grid(2, 1, -1.0, 2.0);
  const std::vector<double> x{-0.9, -0.4, 0.1, 0.3, 0.95};
  const auto fit = taylor(grid, x, values_at(x, noise));
  Eigen::MatrixXd a(5, 3);
  Eigen::VectorXd b(5);
  const auto row = [](double at) { return Eigen::RowVector3d(1.0, at / 2.0, at * at / 8.0 - 1.0 / 24.0); };
  for (Eigen::Index i = 0; i < 5; ++i) {
    a.row(i) = row(x[static_cast<std::size_t>(i)]);
    b(i) = fit.y[static_cast<std::size_t>(i)];
  }
  const Eigen::Vector3d c = a.colPivHouseholderQr().solve(b);
  for (const double at : {-1.0, -0.3, 0.0, 0.8}) CHECK(std::abs(fit(at) - row(at) * c) < 1e-14);
  CHECK(std::abs((fit(-1.0) + 4.0 * fit(0.0) + fit(1.0)) / 6.0 - c(0)) < 1e-14);  // Simpson's rule is exact
}

TEST_CASE("few sites in a cell lower the degree there, and none leave it to the cell before") {
  const SplineSpace grid(1, 8, 0.0, 1.0);
  // No site in the cells 0, 4 and 6, two in 1, one in 2, two in 3, three in 5.
  const std::vector<double> x{1.2, 1.7, 2.3, 3.2, 3.7, 5.1, 5.5, 5.8};
  const auto fit = taylor(grid, x, values_at(x, parabola));
  const auto on_line = [&](double at, double site) {
    const double slope = (parabola(site + 0.5) - parabola(site)) / 0.5;
    return std::abs(fit(at) - parabola(site) - slope * (at - site)) < 1e-14;
  };
  for (const double at : {0.1, 0.9, 1.1, 1.9}) CHECK(on_line(at, 1.2));
  // One site tells no slope: the parabola goes through those beside it, too.
  for (const double at : {2.1, 2.9}) CHECK(std::abs(fit(at) - parabola(at)) < 1e-12);
  for (const double at : {3.1, 4.5}) CHECK(on_line(at, 3.2));
  for (const double at : {5.05, 6.5}) CHECK(std::abs(fit(at) - parabola(at)) < 1e-12);
}

TEST_CASE("an outer cell with one site has a parabola in common with the cell before or after it") {
  const SplineSpace grid(1, 6, 0.0, 1.0);
  const std::vector<double> x{0.9, 1.1, 1.6, 2.2, 2.5, 2.8, 3.2, 3.6, 4.1};
  const auto fit = taylor(grid, x, values_at(x, parabola));
  for (const double at : {0.1, 0.9, 1.1, 1.9, 3.1, 3.9, 4.1, 5.5})
    CHECK(std::abs(fit(at) - parabola(at)) < 1e-12);
  const auto two = taylor(grid, {1.5, 3.5}, {line(1.5), line(3.5)});
  CHECK(std::abs(two(2.5) - line(2.5)) < 1e-14);
  CHECK(taylor(grid, {1.5}, {7.0})(3.0) == 7.0);
}

TEST_CASE("least squares tell which site is out of order") {
  const std::vector<double> x{0.1, 0.2, 0.2, 0.4};
  CHECK(MovingLeastSquares(4).factorise(x) == 2);
  TaylorLeastSquares cells(4, SplineSpace(1, 1, 0.0, 1.0));
  CHECK(cells.factorise(x) == 2);
  TaylorLeastSquares::Fit fit(4);
  CHECK(cells.factorise_and_fit(x, x, fit) == 2);
}
