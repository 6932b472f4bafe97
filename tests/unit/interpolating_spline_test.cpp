// Properties of the interpolating splines of higher degree.
#include <cmath>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/numerics/cubic_spline.hpp>
#include <hompm/numerics/elementary.hpp>
#include <hompm/numerics/interpolating_spline.hpp>

#include "support/catch.hpp"

using hompm::numerics::CubicSplineSites;
using hompm::numerics::InterpolatingSplineSites;

namespace {

std::vector<double> uneven_sites(std::size_t count) {
  std::vector<double> x(count);
  double at = -0.7;
  for (std::size_t i = 0; i < count; ++i) {
    x[i] = at;
    at += 0.1 * (2.0 + hompm::numerics::sin(3.0 * static_cast<double>(i)));
  }
  return x;
}

template <class Sites>
struct Spline {
  Sites sites;
  typename Sites::Fit fit;
  std::vector<double> y;
  Spline(const std::vector<double>& x, std::vector<double> values)
      : sites(x.size()), fit(x.size()), y(std::move(values)) {
    REQUIRE(sites.factorise(x) == 0);
    sites.fit(y, fit);
  }
  [[nodiscard]] double operator()(double x) const { return sites.evaluate(sites.weights(x, 0), fit); }
};

template <int D>
void check_reproduction(std::size_t count) {
  const auto f = [](double x) {
    double sum = 0.0;
    for (int k = D; k >= 0; --k) sum = sum * x + (1.0 - 0.3 * k);
    return sum;
  };
  const auto x = uneven_sites(count);
  std::vector<double> y;
  for (const double site : x) y.push_back(f(site));
  const Spline<InterpolatingSplineSites<D>> spline(x, y);
  for (double at = x.front(); at < x.back(); at += 0.037)
    CHECK(std::abs(spline(at) - f(at)) <
          1e-12 * (1.0 + std::abs(f(x.back()))));  // condition of the collocation ~ 1e3
}

template <class Sites>
double error(std::size_t n, bool slope) {
  std::vector<double> x(n + 1), y(n + 1);
  for (std::size_t i = 0; i <= n; ++i) {
    x[i] = static_cast<double>(i) / static_cast<double>(n);
    y[i] = hompm::numerics::sin_pi(x[i]);
  }
  const Spline<Sites> spline(x, y);
  double worst = 0.0;
  if (slope) {
    for (std::size_t i = 0; i <= n; ++i)
      worst = std::max(worst, std::abs(spline.sites.slope(i, spline.fit) -
                                       hompm::numerics::pi * hompm::numerics::cos_pi(x[i])));
  } else {
    for (int k = 0; k <= 1000; ++k)
      worst = std::max(worst, std::abs(spline(k / 1000.0) - hompm::numerics::sin_pi(k / 1000.0)));
  }
  return worst;
}

}  // namespace

TEST_CASE("a spline of degree D reproduces polynomials of degree D on uneven sites") {
  const std::size_t extra = GENERATE(0u, 1u, 2u, 5u, 30u);
  check_reproduction<3>(4 + extra);
  check_reproduction<5>(6 + extra);
}

TEST_CASE("of degree 3 it is the cubic spline with the not-a-knot condition") {
  const auto x = uneven_sites(15);
  std::vector<double> y;
  for (const double site : x) y.push_back(hompm::numerics::sin(4.0 * site));
  const Spline<InterpolatingSplineSites<3>> one(x, y);
  const Spline<CubicSplineSites> other(x, y);
  for (double at = x.front() - 0.1; at < x.back() + 0.1; at += 0.03)
    CHECK(std::abs(one(at) - other(at)) < 1e-12);
  for (std::size_t i = 0; i < x.size(); ++i)
    CHECK(std::abs(one.sites.slope(i, one.fit) - other.sites.slope(i, other.fit)) < 1e-11);
}

TEST_CASE("degree 5 interpolates at sixth order and its slope at fifth or better") {
  using Quintic = InterpolatingSplineSites<5>;
  CHECK(error<Quintic>(16, false) / error<Quintic>(32, false) > 55.0);
  CHECK(error<Quintic>(16, true) / error<Quintic>(32, true) > 28.0);
}

TEST_CASE("sites that do not ascend, and too few of them, are refused") {
  InterpolatingSplineSites<5> sites(6);
  CHECK(sites.factorise(std::vector{0.0, 1.0, 2.0, 2.0, 4.0, 5.0}) == 3);
  CHECK(sites.factorise(std::vector{0.0, 1.0, 2.0, 3.0, 4.0, 5.0}) == 0);
  CHECK_THROWS_AS(InterpolatingSplineSites<5>(5), hompm::Error);
}
