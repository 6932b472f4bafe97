// Cubic-spline interpolation of several data sets at the same sites: one factorisation serves them all.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace hompm::numerics {

/// Interpolating cubic splines with the not-a-knot end condition (de Boor, A Practical Guide to Splines, ch.
/// IV), in terms of the second derivatives at the sites. Two sites give the straight line, three the
/// parabola. All memory is taken by the constructors.
class CubicSplineSites {
 public:
  static constexpr std::size_t fewest_sites = 2;

  /// `sites` is their number, at least 2; throws `Error` below.
  explicit CubicSplineSites(std::size_t sites);

  /// Takes the sites (m) and factorises the tridiagonal matrix. Returns the index of the first site that is
  /// not above the one before it, or 0 when all are in order; the splines may be used only then.
  [[nodiscard]] std::size_t factorise(std::span<const double> sites);

  /// One spline: the data it passes through, which must outlive its use, and its second derivatives (data
  /// unit/m²) there.
  struct Fit {
    explicit Fit(std::size_t sites) : second_derivatives(sites) {}
    std::span<const double> values;
    std::vector<double> second_derivatives;
  };
  /// The spline through `values`, one per site.
  void fit(std::span<const double> values, Fit& spline) const;
  /// `factorise`, then `fit`: the elimination of the values hides behind the divisions of the matrix'.
  [[nodiscard]] std::size_t factorise_and_fit(std::span<const double> sites, std::span<const double> values,
                                              Fit& spline);

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
  [[nodiscard]] static double evaluate(const Weights& w, const Fit& spline) {
    return (w.left * spline.values[w.interval] + w.right * spline.values[w.interval + 1]) +
           (w.left_derivative * spline.second_derivatives[w.interval] +
            w.right_derivative * spline.second_derivatives[w.interval + 1]);
  }
  /// First derivative (data unit/m) of the spline at site i.
  [[nodiscard]] double slope(std::size_t i, const Fit& spline) const {
    const bool last = i + 1 == count_;
    const std::size_t k = last ? i - 1 : i;
    const double left = spline.second_derivatives[k];
    const double right = spline.second_derivatives[k + 1];
    const double secant = (spline.values[k + 1] - spline.values[k]) * inverse_width_[k];
    const double sixth = width_[k] * (1.0 / 6.0);
    return last ? secant + sixth * (left + 2.0 * right) : secant - sixth * (2.0 * left + right);
  }
  /// The same at every site.
  void slopes(const Fit& spline, std::span<double> result) const;

 private:
  class Reduction;
  template <class Rows>
  std::size_t eliminate(std::span<const double> sites, Rows rows);
  void substitute_back(Fit& spline) const;

  std::size_t count_;
  std::vector<double> sites_;
  std::vector<double> width_;
  std::vector<double> inverse_width_;
  std::vector<double> eliminate_;  ///< row below minus this times row above
  std::vector<double> inverse_pivot_;
  std::vector<double> above_;  ///< coupling to the next unknown
};

}  // namespace hompm::numerics
