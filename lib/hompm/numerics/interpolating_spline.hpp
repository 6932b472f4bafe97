// Spline interpolation of any odd degree, for data that must be known better than a cubic can.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <hompm/error.hpp>

namespace hompm::numerics {

/// Interpolating splines of odd degree D in B-spline form, knots at the sites but the (D − 1)/2 next to each
/// end (for D = 3 the not-a-knot condition): de Boor, A Practical Guide to Splines, ch. XIII. Same use as
/// `CubicSplineSites`. The collocation matrix is totally positive, so elimination needs no pivoting. All
/// memory is taken by the constructors.
template <int D>
class InterpolatingSplineSites {
  static_assert(D % 2 == 1);

 public:
  static constexpr std::size_t fewest_sites = D + 1;

  explicit InterpolatingSplineSites(std::size_t sites)
      : count_(sites),
        sites_(sites),
        knots_(sites + D + 1),
        rows_(sites),
        band_(sites * width),
        inverse_pivot_(sites) {
    if (sites < fewest_sites)
      throw Error("a spline of degree " + std::to_string(D) + " needs at least " + std::to_string(D + 1) +
                  " sites");
  }

  [[nodiscard]] std::size_t factorise(std::span<const double> sites) {
    for (std::size_t i = 1; i < count_; ++i)
      if (!(sites[i] > sites[i - 1])) return i;
    std::copy(sites.begin(), sites.end(), sites_.begin());
    for (std::size_t k = 0; k < knots_.size(); ++k) {
      const std::size_t half = (D + 1) / 2;
      knots_[k] = k <= D ? sites[0] : k >= count_ ? sites[count_ - 1] : sites[k - half];
    }
    std::fill(band_.begin(), band_.end(), 0.0);
    std::size_t interval = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      rows_[i] = weights(sites[i], interval);
      interval = rows_[i].interval;
      for (std::size_t k = 0; k <= D; ++k)
        if (rows_[i].values[k] != 0.0) entry(i, interval + k) = rows_[i].values[k];
    }
    eliminate();
    return 0;
  }

  struct Fit {
    explicit Fit(std::size_t sites) : coefficients(sites) {}
    std::vector<double> coefficients;
  };
  void fit(std::span<const double> values, Fit& spline) const {
    std::vector<double>& c = spline.coefficients;
    for (std::size_t i = 0; i < count_; ++i) {
      double sum = values[i];
      for (std::size_t j = i > reach ? i - reach : 0; j < i; ++j) sum -= entry(i, j) * c[j];
      c[i] = sum;
    }
    for (std::size_t i = count_; i-- > 0;) {
      const std::size_t end = std::min(i + reach + 1, count_);
      for (std::size_t j = i + 1; j < end; ++j) c[i] -= entry(i, j) * c[j];
      c[i] *= inverse_pivot_[i];
    }
  }

  [[nodiscard]] std::size_t factorise_and_fit(std::span<const double> sites, std::span<const double> values,
                                              Fit& spline) {
    const std::size_t bad = factorise(sites);
    if (bad == 0) fit(values, spline);
    return bad;
  }

  /// The D + 1 B-splines that are not zero at a point; the first belongs to coefficient `interval`.
  struct Weights {
    std::size_t interval;
    std::array<double, D + 1> values;
  };
  [[nodiscard]] Weights weights(double x, std::size_t hint) const {
    std::size_t i = hint;
    while (i + D + 1 < count_ && x >= knots_[i + D + 1]) ++i;
    Weights w{i, {}};
    b_splines<D>(x, i + D, w.values);
    return w;
  }
  [[nodiscard]] static double evaluate(const Weights& w, const Fit& spline) {
    double sum = w.values[0] * spline.coefficients[w.interval];
    for (std::size_t k = 1; k <= D; ++k) sum += w.values[k] * spline.coefficients[w.interval + k];
    return sum;
  }
  /// First derivative at site i: D Σ (c_{k} − c_{k−1})/(t_{k+D} − t_k) B_{k,D−1}.
  [[nodiscard]] double slope(std::size_t i, const Fit& spline) const {
    const std::size_t interval = rows_[i].interval;
    std::array<double, D + 1> lower{};
    b_splines<D - 1>(sites_[i], interval + D, lower);
    double sum = 0.0;
    for (std::size_t k = 1; k <= D; ++k) {
      const std::size_t j = interval + k;
      sum +=
          (spline.coefficients[j] - spline.coefficients[j - 1]) / (knots_[j + D] - knots_[j]) * lower[k - 1];
    }
    return D * sum;
  }
  /// The same at every site.
  void slopes(const Fit& spline, std::span<double> result) const {
    for (std::size_t i = 0; i < count_; ++i) result[i] = slope(i, spline);
  }

 private:
  static constexpr std::size_t reach = D - 1;  ///< of the matrix to either side of its diagonal
  static constexpr std::size_t width = 2 * reach + 1;

  double& entry(std::size_t row, std::size_t column) { return band_[row * width + column + reach - row]; }
  [[nodiscard]] double entry(std::size_t row, std::size_t column) const {
    return band_[row * width + column + reach - row];
  }

  /// The B-splines of degree Q that are not zero on [knots[span], knots[span + 1]] (de Boor, ch. X, BSPLVB).
  template <int Q>
  void b_splines(double x, std::size_t span, std::array<double, D + 1>& values) const {
    std::array<double, D + 1> right{};
    std::array<double, D + 1> left{};
    values[0] = 1.0;
    for (std::size_t q = 1; q <= Q; ++q) {
      right[q] = knots_[span + q] - x;
      left[q] = x - knots_[span + 1 - q];
      double saved = 0.0;
      for (std::size_t k = 0; k < q; ++k) {
        const double term = values[k] / (right[k + 1] + left[q - k]);
        values[k] = saved + right[k + 1] * term;
        saved = left[q - k] * term;
      }
      values[q] = saved;
    }
  }

  void eliminate() {
    for (std::size_t i = 0; i < count_; ++i) {
      inverse_pivot_[i] = 1.0 / entry(i, i);
      const std::size_t end = std::min(i + reach + 1, count_);
      for (std::size_t row = i + 1; row < end; ++row) {
        if (entry(row, i) == 0.0) continue;
        const double factor = entry(row, i) * inverse_pivot_[i];
        entry(row, i) = factor;
        for (std::size_t column = i + 1; column < end; ++column)
          entry(row, column) -= factor * entry(i, column);
      }
    }
  }

  std::size_t count_;
  std::vector<double> sites_, knots_;
  std::vector<Weights> rows_;
  std::vector<double> band_, inverse_pivot_;
};

}  // namespace hompm::numerics
