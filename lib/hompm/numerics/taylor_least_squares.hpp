// Least squares cell by cell.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <hompm/numerics/orthogonal_quadratics.hpp>
#include <hompm/numerics/spline_space.hpp>

namespace hompm::numerics {

/// In each cell of a grid the parabola nearest to the data of the sites there (E. Wobbes, M. Möller, V.
/// Galavi, C. Vuik, Int. J. Numer. Methods Engrg. 117 (2019) 271–290), with a jump at the breakpoints. Two
/// sites in a cell give a line; one, which tells no slope, the parabola through it and those beside it. A
/// cell without sites takes the parabola of the one before it, or of the first that has one. An outer cell
/// with one site has a parabola in common with the next that has sites. Same use as `CubicSplineSites`, but
/// for slopes.
class TaylorLeastSquares {
 public:
  /// `sites` is their number, at least 1.
  TaylorLeastSquares(std::size_t sites, const SplineSpace& grid);

  /// Takes the sites (m), all on the grid. Returns the index of the first one that is not above the one
  /// before it, or 0 when all are in order; the fits may be used only then.
  [[nodiscard]] std::size_t factorise(std::span<const double> sites);

  /// The coefficients of each piece.
  struct Fit {
    explicit Fit(std::size_t sites) : coefficients(sites) {}
    std::vector<std::array<double, 3>> coefficients;
  };
  /// The pieces nearest to `values`, one per site.
  void fit(std::span<const double> values, Fit& fit) const;
  [[nodiscard]] std::size_t factorise_and_fit(std::span<const double> sites, std::span<const double> values,
                                              Fit& fit);

  /// The piece of a point, and its polynomials there.
  struct Weights {
    std::size_t interval;
    double q1, q2;
  };
  /// `hint` is a piece at or before that of the point.
  [[nodiscard]] Weights weights(double x, std::size_t hint) const {
    std::size_t piece = hint;
    while (piece + 1 < count_ && x >= pieces_[piece + 1].start) ++piece;
    const Piece& at = pieces_[piece];
    const double t = (x - at.start) * inverse_width_;
    return {piece, at.basis.q1(t), at.basis.q2(t)};
  }
  [[nodiscard]] static double evaluate(const Weights& w, const Fit& fit) {
    const auto& c = fit.coefficients[w.interval];
    return c[0] + c[1] * w.q1 + c[2] * w.q2;
  }

 private:
  struct Piece {
    std::size_t begin, end;  ///< of its sites
    double start;            ///< m, of its cell
    OrthogonalQuadratics basis;
  };

  SplineSpace grid_;
  double inverse_width_;
  std::size_t count_ = 0;      ///< of the pieces
  std::vector<double> place_;  ///< of the sites of each piece in its cell, in cell widths
  std::vector<Piece> pieces_;
};

}  // namespace hompm::numerics
