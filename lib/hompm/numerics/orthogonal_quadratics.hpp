// Least squares by a parabola on a few sites, without a matrix.
#pragma once

#include <array>
#include <cstddef>

namespace hompm::numerics {

/// The polynomials 1, q₁ = t − mean, q₂ = q₁² − tilt q₁ − level, orthogonal in the sum over weighted sites
/// (G. E. Forsythe, J. Soc. Indust. Appl. Math. 5 (1957) 74–88): the parabola nearest to data f is Σ_k (Σ w f
/// q_k)(inverse norm)_k q_k. Two sites determine a line, one a constant: the inverse norms of what they leave
/// open are 0.
struct OrthogonalQuadratics {
  double mean = 0.0, tilt = 0.0, level = 0.0;
  std::array<double, 3> inverse_norm{};  ///< 1/Σ w q_k²

  [[nodiscard]] double q1(double t) const { return t - mean; }
  [[nodiscard]] double q2(double t) const { return (q1(t) - tilt) * q1(t) - level; }
};

/// Of `count` ≥ 1 distinct sites, at `site(i)` with weights `weight(i)` ≥ 0.
template <class Site, class Weight>
OrthogonalQuadratics orthogonal_quadratics(std::size_t count, Site site, Weight weight) {
  OrthogonalQuadratics q;
  double weights = 0.0, first_moment = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    weights += weight(i);
    first_moment += weight(i) * site(i);
  }
  q.inverse_norm[0] = 1.0 / weights;
  q.mean = first_moment * q.inverse_norm[0];
  if (count < 2) return q;
  double second_moment = 0.0, third_moment = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double d = q.q1(site(i));
    second_moment += weight(i) * d * d;
    third_moment += weight(i) * d * d * d;
  }
  q.inverse_norm[1] = 1.0 / second_moment;
  q.tilt = third_moment * q.inverse_norm[1];
  q.level = second_moment * q.inverse_norm[0];
  if (count < 3) return q;
  double norm = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double value = q.q2(site(i));
    norm += weight(i) * value * value;
  }
  q.inverse_norm[2] = 1.0 / norm;
  return q;
}

}  // namespace hompm::numerics
