// Direct solution of symmetric positive definite band systems.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace hompm::numerics {

/// L D Lᵀ factorisation of a symmetric matrix with half-bandwidth P, stored by rows of the lower triangle:
/// entry (i, i − k) at [i][k], k = 0 … P (Golub & Van Loan, Matrix Computations, 4.3). O(n P²) to factorise,
/// O(n P) to solve; all memory is taken by the constructor.
template <int P>
class BandLdlt {
 public:
  explicit BandLdlt(std::size_t rows) : band_(rows * (P + 1)), inverse_pivot_(rows) {}

  void clear() { std::fill(band_.begin(), band_.end(), 0.0); }
  /// Entry (row, row − k) for assembly; only before `factorise`.
  double& lower(std::size_t row, std::size_t k) { return band_[row * (P + 1) + k]; }
  [[nodiscard]] double lower(std::size_t row, std::size_t k) const { return band_[row * (P + 1) + k]; }

  /// Factorises rows first … last − 1 in place, entries to columns before `first` ignored. Returns `last`, or
  /// the first row whose pivot is not above zero: the matrix is then not positive definite and `solve` must
  /// not be called.
  [[nodiscard]] std::size_t factorise(std::size_t first, std::size_t last) {
    const std::size_t edge = std::min<std::size_t>(P, last - first);
    for (std::size_t i = first; i < first + edge; ++i)
      if (!eliminate(i, i - first)) return i;
    for (std::size_t i = first + edge; i < last; ++i)
      if (!eliminate(i, P)) return i;
    return last;
  }

  /// Solves for the rows that were factorised; `x` holds the right-hand side on entry and the solution on
  /// return.
  void solve(std::size_t first, std::size_t last, std::span<double> x) const {
    const auto forward = [&](std::size_t i, std::size_t reach) {
      double sum = x[i];
      for (std::size_t k = 1; k <= reach; ++k) sum -= lower(i, k) * x[i - k];
      x[i] = sum;
    };
    const auto backward = [&](std::size_t i, std::size_t reach) {
      double sum = x[i] * inverse_pivot_[i];
      for (std::size_t k = 1; k <= reach; ++k) sum -= lower(i + k, k) * x[i + k];
      x[i] = sum;
    };
    const std::size_t edge = std::min<std::size_t>(P, last - first);
    for (std::size_t i = first; i < first + edge; ++i) forward(i, i - first);
    for (std::size_t i = first + edge; i < last; ++i) forward(i, P);
    for (std::size_t i = last; i-- > last - edge;) backward(i, last - 1 - i);
    for (std::size_t i = last - edge; i-- > first;) backward(i, P);
  }

 private:
  /// Row i with `reach` entries before the diagonal, a constant for inner rows: compilers unroll these loops.
  /// False when the pivot is not above zero.
  bool eliminate(std::size_t i, std::size_t reach) {
    double pivot = lower(i, 0);
    for (std::size_t k = reach; k >= 1; --k) {  // column j = i − k
      double entry = lower(i, k);
      for (std::size_t m = 1; m <= reach - k; ++m) entry -= lower(i, k + m) * lower(i - k, m);
      lower(i, k) = entry;  // L(i,j) D(j) until the row is complete
    }
    for (std::size_t k = 1; k <= reach; ++k) {
      const double factor = lower(i, k) * inverse_pivot_[i - k];
      pivot -= factor * lower(i, k);
      lower(i, k) = factor;
    }
    if (!(pivot > 0.0)) return false;
    inverse_pivot_[i] = 1.0 / pivot;
    return true;
  }

  std::vector<double> band_;
  std::vector<double> inverse_pivot_;
};

}  // namespace hompm::numerics
