// Moving least squares through data at scattered sites.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/numerics/orthogonal_quadratics.hpp>

namespace hompm::numerics {

/// The value at x of the parabola nearest to the data around x (P. Lancaster, K. Salkauskas, Math. Comp. 37
/// (1981) 141–158), by a cubic-spline weight of the distance. The weight reaches to the nearest site beyond
/// `neighbours` ones, so that the parabola is determined however sites are spread, and the value changes
/// continuously with x and with the sites. Parabolas are reproduced. Same use as `CubicSplineSites`, but for
/// slopes.
class MovingLeastSquares {
 public:
  static constexpr std::size_t neighbours = 6;

  /// `sites` is their number, at least 1; throws `Error` below. Few sites give the parabola, the line or the
  /// constant nearest to all of them.
  explicit MovingLeastSquares(std::size_t sites) : sites_(sites), reach_(std::min(sites, neighbours)) {
    if (sites == 0) throw Error("moving least squares needs a site");
  }

  /// Takes the sites (m). Returns the index of the first one that is not above the one before it, or 0 when
  /// all are in order; the fits may be used only then.
  [[nodiscard]] std::size_t factorise(std::span<const double> sites) {
    for (std::size_t i = 1; i < sites.size(); ++i)
      if (!(sites[i] > sites[i - 1])) return i;
    std::copy(sites.begin(), sites.end(), sites_.begin());
    return 0;
  }

  /// The data, which must outlive their use.
  struct Fit {
    explicit Fit(std::size_t /*sites*/) {}
    std::span<const double> values;
  };
  void fit(std::span<const double> values, Fit& fit) const { fit.values = values; }
  [[nodiscard]] std::size_t factorise_and_fit(std::span<const double> sites, std::span<const double> values,
                                              Fit& fit) {
    fit.values = values;
    return factorise(sites);
  }

  /// What the data from site `interval` on weigh at a point.
  struct Weights {
    std::size_t interval;
    std::array<double, neighbours> values;
  };
  /// `hint` as in `CubicSplineSites::weights`.
  [[nodiscard]] Weights weights(double x, std::size_t hint) const;
  [[nodiscard]] double evaluate(const Weights& w, const Fit& fit) const {
    double sum = w.values[0] * fit.values[w.interval];
    for (std::size_t k = 1; k < reach_; ++k) sum += w.values[k] * fit.values[w.interval + k];
    return sum;
  }

 private:
  std::vector<double> sites_;
  std::size_t reach_;  ///< sites that count at a point
};

}  // namespace hompm::numerics
