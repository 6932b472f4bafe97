// B-splines on an open uniform knot vector: the function space of the background grid.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

namespace hompm::numerics {

/// `cells` knot spans of equal width; first and last knot repeated so that the boundary functions
/// interpolate. There are `cells + degree` functions; on cell c the functions c … c + degree are not zero.
/// Degree 1 is the classical hat function.
///
/// Every function is one polynomial per cell, of the local coordinate s ∈ [0, 1], kept as an expansion about
/// each end of the cell: about the nearer one the functions that vanish there keep all their digits, which
/// thin cut spans need. Inside the grid all cells share one set; only the first and last `degree − 1` differ.
class SplineSpace {
 public:
  /// `origin` and `cell_width` in m. Throws `Error` unless 1 ≤ degree ≤ 5, cells ≥ 1 and cell_width > 0.
  SplineSpace(int degree, int cells, double origin, double cell_width);

  [[nodiscard]] int degree() const { return degree_; }
  [[nodiscard]] int cells() const { return cells_; }
  [[nodiscard]] int functions() const { return cells_ + degree_; }
  [[nodiscard]] double origin() const { return origin_; }
  [[nodiscard]] double cell_width() const { return cell_width_; }
  /// Position (m) of the breakpoint between cells i − 1 and i.
  [[nodiscard]] double breakpoint(int i) const { return origin_ + static_cast<double>(i) * cell_width_; }

  /// Cell and local coordinate of a position.
  struct Location {
    int cell;  ///< −1 when the position is outside the grid or not a number
    double s;
  };
  /// The end of the grid belongs to the last cell, so that the last function is 1 there and not 0.
  [[nodiscard]] Location locate(double x) const {
    const double q = (x - origin_) * inverse_width_;
    if (!(q >= 0.0 && q <= static_cast<double>(cells_))) return {-1, 0.0};
    int cell = static_cast<int>(q);
    if (cell == cells_) --cell;
    return {cell, q - static_cast<double>(cell)};
  }

  /// Values and derivatives d/dx (1/m) of the `P + 1` functions that live on a cell; P must be the degree.
  template <int P>
  void evaluate(Location at, double* values, double* gradients) const {
    constexpr std::size_t n = P + 1;
    const bool upper = at.s > 0.5;
    const double t = at.s - (upper ? 1.0 : 0.0);
    const double* c = pieces_.data() + (2 * piece_of_cell<P>(at.cell) + (upper ? 1 : 0)) * (n * n);
    for (std::size_t k = 0; k + 2 <= n; k += 2) horner<P, Pair>(c + k, t, values + k, gradients + k);
    if constexpr (n % 2 == 1) horner<P, double>(c + P, t, values + P, gradients + P);
  }

  /// The same with the degree known only at run time; both spans hold degree + 1 numbers.
  void evaluate(Location at, std::span<double> values, std::span<double> gradients) const;

 private:
  /// Two functions at a time: compilers do not find that out.
  using Pair [[gnu::vector_size(16)]] = double;

  /// Horner's rule for the functions side by side in a `Number`; `c` has a row of P + 1 for each power.
  template <int P, class Number>
  void horner(const double* c, double t, double* values, double* gradients) const {
    const auto row = [c](std::size_t power) {
      Number coefficient;
      std::memcpy(&coefficient, c + power * (P + 1), sizeof coefficient);
      return coefficient;
    };
    Number slope = row(P);
    Number value = slope * t + row(P - 1);
    for (std::size_t power = P - 1; power-- > 0;) {
      slope = slope * t + value;
      value = value * t + row(power);
    }
    slope *= inverse_width_;
    std::memcpy(values, &value, sizeof value);
    std::memcpy(gradients, &slope, sizeof slope);
  }

  /// Cells share the piece `P − 1` but for those at the ends.
  template <int P>
  [[nodiscard]] std::size_t piece_of_cell(int cell) const {
    return static_cast<std::size_t>(cell - std::clamp(cell - (P - 1), 0, shared_));
  }

  int degree_;
  int cells_;
  double origin_;
  double cell_width_;
  double inverse_width_;
  int shared_;                  ///< cells that share a piece with the one before them
  std::vector<double> pieces_;  ///< [piece][lower or upper end][power][function]
};

}  // namespace hompm::numerics
