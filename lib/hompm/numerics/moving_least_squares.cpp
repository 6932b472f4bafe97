#include <cmath>

#include <hompm/numerics/moving_least_squares.hpp>

namespace hompm::numerics {
namespace {

/// The cubic B-spline on [−1, 1] (J. J. Monaghan, J. C. Lattanzio, Astron. Astrophys. 149 (1985) 135–143), 1
/// at its top.
double kernel(double distance) {
  const double rest = 1.0 - distance;
  return distance < 0.5 ? 1.0 - 6.0 * distance * distance * rest : 2.0 * rest * rest * rest;
}

}  // namespace

MovingLeastSquares::Weights MovingLeastSquares::weights(double x, std::size_t hint) const {
  const std::size_t count = sites_.size();
  const double* s = sites_.data();
  std::size_t first = hint;
  while (first + reach_ < count && s[first + reach_] - x < x - s[first]) ++first;
  double radius = 0.0;  // to the nearest site that does not count
  if (first > 0) radius = x - s[first - 1];
  if (first + reach_ < count && (first == 0 || s[first + reach_] - x < radius))
    radius = s[first + reach_] - x;
  // Without such a site all weigh the same.
  const double scale = radius > 0.0 ? 1.0 / radius : 0.0;

  Weights result{first, {}};
  std::array<double, neighbours> at{}, weight{};
  for (std::size_t k = 0; k < reach_; ++k) {
    at[k] = s[first + k] - x;
    weight[k] = kernel(std::abs(at[k]) * scale);
  }
  const auto q = orthogonal_quadratics(
      reach_, [&](std::size_t k) { return at[k]; }, [&](std::size_t k) { return weight[k]; });
  const double line = q.inverse_norm[1] * q.q1(0.0);
  const double parabola = q.inverse_norm[2] * q.q2(0.0);
  for (std::size_t k = 0; k < reach_; ++k)
    result.values[k] = weight[k] * (q.inverse_norm[0] + line * q.q1(at[k]) + parabola * q.q2(at[k]));
  return result;
}

}  // namespace hompm::numerics
