// The largest eigenvalue of a linear map that is known by its products with vectors.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace hompm::numerics {

/// What of a spectrum was found by `rounds` products with the map.
struct SpectralRadius {
  double value = 0.0;      ///< |λ|max
  double rightmost = 0.0;  ///< the largest real part, to a hundredth of `value`
  int rounds = 0;
  bool converged = false;
};

/// |λ|max of the map x ↦ `apply(x)` of vectors of length `size`, symmetric or not, to the relative
/// `tolerance`: by Arnoldi's method (W. E. Arnoldi, Quart. Appl. Math. 9 (1951) 17–29) from a fixed
/// pseudo-random start, until the value changes by less than a third of `tolerance` in four rounds, twice in
/// a row, or after `most` rounds. Sums run in a fixed order: the same map gives the same bits. Keeps one
/// vector a round.
SpectralRadius spectral_radius(
    std::size_t size, const std::function<void(const std::vector<double>& x, std::vector<double>& y)>& apply,
    double tolerance, int most);

}  // namespace hompm::numerics
