// B-splines on an open uniform knot vector: the function space of the background grid.
#pragma once

#include <cstddef>
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
    const bool upper = at.s > 0.5;
    const double* c = piece(at.cell) + (upper ? (P + 1) * (P + 1) : 0);
    const double t = upper ? at.s - 1.0 : at.s;
    for (int k = 0; k <= P; ++k) {
      double value = c[P * (P + 1) + k];
      double slope = 0.0;
      for (int power = P - 1; power >= 0; --power) {
        slope = slope * t + value;
        value = value * t + c[power * (P + 1) + k];
      }
      values[k] = value;
      gradients[k] = slope * inverse_width_;
    }
  }

  /// The same with the degree known only at run time; both spans hold degree + 1 numbers.
  void evaluate(Location at, std::span<double> values, std::span<double> gradients) const;

 private:
  [[nodiscard]] const double* piece(int cell) const {
    return pieces_.data() + static_cast<std::size_t>(piece_of_cell(cell)) * piece_size_;
  }
  [[nodiscard]] int piece_of_cell(int cell) const {
    const int inner = degree_ - 1;
    if (cell < inner || cells_ <= 2 * inner) return cell;
    const int from_end = cells_ - 1 - cell;
    return from_end < inner ? 2 * inner - from_end : inner;
  }

  int degree_;
  int cells_;
  double origin_;
  double cell_width_;
  double inverse_width_;
  std::size_t piece_size_;
  std::vector<double> pieces_;  ///< [piece][lower or upper end][power][function]
};

}  // namespace hompm::numerics
