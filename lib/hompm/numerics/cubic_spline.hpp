// Cubic-spline interpolation of several data sets at the same sites: one factorisation serves them all.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace hompm::numerics {

/// Interpolating cubic splines with the not-a-knot end condition (de Boor, A Practical Guide to Splines, ch.
/// IV), in terms of the second derivatives at the sites. Two sites give the straight line, three the
/// parabola. All memory is taken by the constructor.
class CubicSplineSites {
 public:
  /// `sites` is their number, at least 2; throws `Error` below.
  explicit CubicSplineSites(std::size_t sites);

  /// Takes the sites (m) and factorises the tridiagonal matrix. Returns the index of the first site that is
  /// not above the one before it, or 0 when all are in order; the splines may be used only then.
  [[nodiscard]] std::size_t factorise(std::span<const double> sites);

  /// Second derivatives (data unit/m²) at the sites of the spline through `values`.
  void second_derivatives(std::span<const double> values, std::span<double> result) const;

  /// Where a point lies and what the four data around it weigh: the same for every data set on these sites.
  struct Weights {
    std::size_t interval;
    double left, right;                        ///< of the values at the ends of the interval
    double left_derivative, right_derivative;  ///< of the second derivatives there
  };
  /// Points outside the sites use the first or last cubic. `hint` is an interval at or before the right one:
  /// points in ascending order are located in one walk.
  [[nodiscard]] Weights weights(double x, std::size_t hint) const {
    std::size_t i = hint;
    while (i + 2 < count_ && x >= sites_[i + 1]) ++i;
    const double right = (x - sites_[i]) * inverse_width_[i];
    const double left = 1.0 - right;
    const double scale = width_[i] * width_[i] * (1.0 / 6.0);
    return {i, left, right, (left * left * left - left) * scale, (right * right * right - right) * scale};
  }
  [[nodiscard]] static double evaluate(const Weights& w, std::span<const double> values,
                                       std::span<const double> second_derivatives) {
    return (w.left * values[w.interval] + w.right * values[w.interval + 1]) +
           (w.left_derivative * second_derivatives[w.interval] +
            w.right_derivative * second_derivatives[w.interval + 1]);
  }

 private:
  std::size_t count_;
  std::vector<double> sites_;
  std::vector<double> width_;
  std::vector<double> inverse_width_;
  std::vector<double> eliminate_;  ///< row below minus this times row above
  std::vector<double> inverse_pivot_;
  std::vector<double> above_;  ///< coupling to the next unknown
};

}  // namespace hompm::numerics
