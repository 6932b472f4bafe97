// Gauss points on the knot spans that hold material.
#pragma once

#include <vector>

#include <hompm/numerics/gauss_legendre.hpp>
#include <hompm/numerics/spline_space.hpp>

namespace hompm::detail {

/// In cells. An end of the material that is on a breakpoint but for this touches one side of it, left and
/// right alike.
inline constexpr double rounding_of_ends = 1e-10;

/// The cells that material from `left` to `right`, both on the grid, fills: the first from `s` on, the last
/// up to `s`.
struct FilledCells {
  numerics::SplineSpace::Location first, last;
};
inline FilledCells filled_cells(const numerics::SplineSpace& grid, double left, double right) {
  FilledCells filled{grid.locate(left), grid.locate(right)};
  if (filled.first.s > 1.0 - rounding_of_ends) filled.first = {filled.first.cell + 1, 0.0};
  if (filled.last.s < rounding_of_ends && filled.last.cell > filled.first.cell)
    filled.last = {filled.last.cell - 1, 1.0};
  return filled;
}

/// Each span is split into two halves with `PerHalf` points in each (Tielen et al. 2017 use 2 for P = 2), and
/// a span that the material fills partly is integrated over the filled part alone. Points, weights and basis
/// are kept per cell and computed again only where the filled part of a cell has changed.
template <int P, int PerHalf>
class GaussPoints {
 public:
  static constexpr int per_cell = 2 * PerHalf;
  static constexpr std::size_t stencil = P + 1;

  explicit GaussPoints(const numerics::SplineSpace& grid)
      : rule_(numerics::gauss_legendre(per_cell / 2)), filled_(static_cast<std::size_t>(grid.cells())) {
    const auto points = filled_.size() * per_cell;
    position_.resize(points);
    weight_.resize(points);
    values_.resize(points * stencil);
    gradients_.resize(points * stencil);
  }

  /// Material from `left` to `right`, both inside the grid, `left` < `right`.
  void cover(const numerics::SplineSpace& grid, double left, double right) {
    const auto [from, to] = filled_cells(grid, left, right);
    first_ = from.cell;
    last_ = to.cell;
    for (int cell = first_; cell <= last_; ++cell) {
      const Interval part{cell == from.cell ? from.s : 0.0, cell == to.cell ? to.s : 1.0};
      if (part != filled_[static_cast<std::size_t>(cell)]) fill(grid, cell, part);
    }
  }

  [[nodiscard]] std::size_t cells() const { return filled_.size(); }  ///< of the grid
  /// The cells that hold material.
  [[nodiscard]] int first_cell() const { return first_; }
  [[nodiscard]] int last_cell() const { return last_; }
  /// The points of those cells are begin … end − 1, ascending.
  [[nodiscard]] std::size_t begin() const { return static_cast<std::size_t>(first_) * per_cell; }
  [[nodiscard]] std::size_t end() const { return static_cast<std::size_t>(last_ + 1) * per_cell; }
  [[nodiscard]] std::size_t capacity() const { return position_.size(); }

  [[nodiscard]] double position(std::size_t point) const { return position_[point]; }  ///< m
  [[nodiscard]] double weight(std::size_t point) const { return weight_[point]; }      ///< m
  /// Values and gradients (1/m) of the functions cell … cell + P.
  [[nodiscard]] const double* values(std::size_t point) const { return &values_[point * stencil]; }
  [[nodiscard]] const double* gradients(std::size_t point) const { return &gradients_[point * stencil]; }

 private:
  struct Interval {
    double from = 0.0, to = 0.0;
    bool operator==(const Interval&) const = default;
  };

  void fill(const numerics::SplineSpace& grid, int cell, Interval part) {
    filled_[static_cast<std::size_t>(cell)] = part;
    const double half = 0.5 * (part.to - part.from);
    auto point = static_cast<std::size_t>(cell) * per_cell;
    for (const double start : {part.from, part.from + half}) {
      for (std::size_t g = 0; g < rule_.points.size(); ++g, ++point) {
        const double s = start + half * rule_.points[g];
        position_[point] = grid.breakpoint(cell) + s * grid.cell_width();
        weight_[point] = half * rule_.weights[g] * grid.cell_width();
        grid.evaluate<P>({cell, s}, &values_[point * stencil], &gradients_[point * stencil]);
      }
    }
  }

  numerics::GaussRule rule_;
  std::vector<Interval> filled_;
  std::vector<double> position_, weight_, values_, gradients_;
  int first_ = 0;
  int last_ = -1;
};

}  // namespace hompm::detail
