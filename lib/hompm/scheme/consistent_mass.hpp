// The consistent mass matrix of the grid, and its free ends.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <hompm/numerics/band_ldlt.hpp>
#include <hompm/plan/invalid.hpp>
#include <hompm/scene/scheme_choices.hpp>

namespace hompm::detail {

/// A matrix Σ w N_i N_j over the functions of the grid, factorised for those that touch material and no
/// essential condition fixes. With w = w_g ρ at Gauss points it is the consistent mass.
///
/// At a free end with extension the one function that lives on the cut span alone, whose mass vanishes with
/// the cut, is tied to the P + 1 next to it so that polynomials of degree P are kept: c_j = Σ_{k=1}^{P+1}
/// e_k c_{j∓k}, with e_k = (−1)^{k+1} C(P+1, k) on uniform knots (extended B-splines: Höllig, Reif, Wipper
/// 2001; for MPM Yamaguchi, Moriguchi, Terada 2021). The system is then Cᵀ M C with right-hand side Cᵀ f, of
/// the same bandwidth.
template <int P>
class ConsistentMass {
 public:
  ConsistentMass(const State& state, const SchemeChoices& choices)
      : matrix_(static_cast<std::size_t>(state.grid.functions())),
        extended_(choices.free_end == FreeEnd::extension),
        fixed_afterwards_(choices.essential_conditions == EssentialConditions::after_solution) {
    for (int j = 0; j < P; ++j) extensions_[static_cast<std::size_t>(j)] = extension_of(j);
  }

  void clear() { matrix_.clear(); }
  /// M_ij and M_ji, j ≤ i, to add to between `clear` and `factorise`.
  double& entry(std::size_t i, std::size_t j) { return matrix_.lower(i, i - j); }

  /// Functions begin … end − 1 touch material. `diagonal`, one entry per function or none, is added to the
  /// diagonal: of Cᵀ M C as Cᵀ diagonal, so that row sums change by it there, too; it is overwritten. Throws
  /// `InvalidRun` when the matrix is not positive definite.
  void factorise(const State& state, std::size_t begin, std::size_t end, std::span<double> diagonal = {}) {
    touched_begin_ = begin_ = begin;
    touched_end_ = end_ = end;
    for (std::size_t k = 0; k <= P; ++k) {
      left_row_[k] = matrix_.lower(begin + k, k);
      right_row_[k] = matrix_.lower(end - 1, k);
    }
    fixed_left_ = state.ends.left == End::fixed;
    fixed_right_ = state.ends.right == End::fixed;
    tied_left_ = extended_ && !fixed_left_;
    tied_right_ = extended_ && !fixed_right_;
    if (end - begin < 2 * (std::size_t{P} + 2)) {
      // Too few functions to tie: a body of a cell or two has no inside to extend from.
      tied_left_ = tied_right_ = false;
    }
    const std::size_t beyond = static_cast<std::size_t>(state.grid.functions()) - end;
    left_extension_ = extensions_[std::min<std::size_t>(begin, P - 1)];
    right_extension_ = extensions_[std::min<std::size_t>(beyond, P - 1)];
    if (tied_left_) tie(begin, +1);
    if (tied_right_) tie(end - 1, -1);
    if (!diagonal.empty()) add_diagonal(diagonal);
    if ((fixed_left_ && !fixed_afterwards_) || tied_left_) ++begin_;
    if ((fixed_right_ && !fixed_afterwards_) || tied_right_) --end_;
    if (const std::size_t row = matrix_.factorise(begin_, end_); row != end_) throw_singular_mass(state, row);
  }

  /// Moves what acts on a tied function to those it is tied to: Cᵀ f.
  void untie(std::vector<double>& force) const {
    const auto move = [&](std::size_t j, int direction) {
      gather_tied(force, j, direction);
      force[j] = 0.0;
    };
    if (tied_left_) move(touched_begin_, +1);
    if (tied_right_) move(touched_end_ - 1, -1);
  }

  /// Solves M x = b for the field `x`, which holds b on entry; fixed functions and those without material get
  /// zero. Returns what the conditions at fixed ends add to Σ b: the sum of the reactions.
  double solve(std::vector<double>& x) const {
    const double left = x[touched_begin_];
    const double right = x[touched_end_ - 1];
    if (tied_left_) gather_tied(x, touched_begin_, +1);
    if (tied_right_) gather_tied(x, touched_end_ - 1, -1);
    std::fill_n(x.begin(), begin_, 0.0);
    std::fill(x.begin() + static_cast<std::ptrdiff_t>(end_), x.end(), 0.0);
    matrix_.solve(begin_, end_, x);
    if (tied_left_) x[touched_begin_] = tied_value(x, touched_begin_, +1);
    if (tied_right_) x[touched_end_ - 1] = tied_value(x, touched_end_ - 1, -1);

    double reaction = 0.0;
    if (fixed_afterwards_) {
      if (fixed_left_) reaction -= set_to_zero(x[touched_begin_], left_row_);
      if (fixed_right_) reaction -= set_to_zero(x[touched_end_ - 1], right_row_);
      return reaction;
    }
    if (fixed_left_) reaction += inertia_at_left_end(x) - left;
    if (fixed_right_) reaction += inertia_at_right_end(x) - right;
    return reaction;
  }

 private:
  /// Σ_j M_ij a_j for the fixed function at the left or right end: what of the force there the motion takes.
  [[nodiscard]] double inertia_at_left_end(const std::vector<double>& a) const {
    double sum = 0.0;
    for (std::size_t k = 0; k <= P; ++k) sum += left_row_[k] * a[touched_begin_ + k];
    return sum;
  }
  [[nodiscard]] double inertia_at_right_end(const std::vector<double>& a) const {
    double sum = 0.0;
    for (std::size_t k = 0; k <= P; ++k) sum += right_row_[k] * a[touched_end_ - 1 - k];
    return sum;
  }

  /// Returns Σ_i M_ij of the fixed function j times its value `a`, which it sets to zero.
  static double set_to_zero(double& a, const std::array<double, P + 1>& row) {
    double sum = 0.0;
    for (const double entry : row) sum += entry * a;
    a = 0.0;
    return sum;
  }

  using Extension = std::array<double, P + 1>;

  /// e_k of the function j from the left end of the grid, whose first knot comes P + 1 times; from j = P − 1
  /// on all that count are uniform. The derivative of order P of a polynomial has one coefficient on all
  /// cells: the difference of two, as c_j … c_{j+P+1} give them (de Boor, ch. X: c′_i = P (c_i − c_{i−1}) /
  /// (t_{i+P} − t_i), and so on), is 0.
  static Extension extension_of(int j) {
    const auto knot = [](int i) { return std::max(i - P, 0); };
    std::array<std::array<double, P + 2>, P + 2> derivative{};  // [function][coefficient it is made of]
    for (std::size_t i = 0; i < P + 2; ++i) derivative[i][i] = 1.0;
    for (int order = 1; order <= P + 1; ++order)
      for (int i = P + 1; i >= order; --i) {
        const int degree = P + 1 - order;
        const double scale =
            degree == 0 ? 1.0 : static_cast<double>(degree) / (knot(j + i + degree) - knot(j + i));
        auto& upper = derivative[static_cast<std::size_t>(i)];
        const auto& lower = derivative[static_cast<std::size_t>(i - 1)];
        for (std::size_t k = 0; k < P + 2; ++k) upper[k] = scale * (upper[k] - lower[k]);
      }
    Extension e;
    for (std::size_t k = 0; k <= P; ++k) e[k] = -derivative[P + 1][k + 1] / derivative[P + 1][0];
    return e;
  }

  [[nodiscard]] const Extension& extension(int direction) const {
    return direction > 0 ? left_extension_ : right_extension_;
  }

  static std::size_t next(std::size_t j, std::size_t k, int direction) {
    return direction > 0 ? j + k : j - k;
  }

  double& at(std::size_t i, std::size_t j) {
    return i > j ? matrix_.lower(i, i - j) : matrix_.lower(j, j - i);
  }

  /// Cᵀ M C for the tied function j: row and column j go to the functions it is tied to.
  void tie(std::size_t j, int direction) {
    const Extension& e = extension(direction);
    std::array<double, P + 2> coupling{};  // M_{j, j∓k}
    for (std::size_t k = 0; k <= P; ++k) coupling[k] = at(j, next(j, k, direction));
    for (std::size_t a = 1; a <= P + 1; ++a)
      for (std::size_t b = 1; b <= a; ++b) {
        const double ea = e[a - 1];
        const double eb = e[b - 1];
        at(next(j, a, direction), next(j, b, direction)) +=
            ea * coupling[b] + eb * coupling[a] + ea * eb * coupling[0];
      }
  }

  void add_diagonal(std::span<double> diagonal) {
    if (tied_left_) gather_tied(diagonal, touched_begin_, +1);
    if (tied_right_) gather_tied(diagonal, touched_end_ - 1, -1);
    for (std::size_t i = touched_begin_; i < touched_end_; ++i) matrix_.lower(i, 0) += diagonal[i];
    left_row_[0] += diagonal[touched_begin_];
    right_row_[0] += diagonal[touched_end_ - 1];
  }

  void gather_tied(std::span<double> b, std::size_t j, int direction) const {
    const Extension& e = extension(direction);
    for (std::size_t k = 1; k <= P + 1; ++k) b[next(j, k, direction)] += e[k - 1] * b[j];
  }

  [[nodiscard]] double tied_value(const std::vector<double>& x, std::size_t j, int direction) const {
    const Extension& e = extension(direction);
    double sum = 0.0;
    for (std::size_t k = 1; k <= P + 1; ++k) sum += e[k - 1] * x[next(j, k, direction)];
    return sum;
  }

  numerics::BandLdlt<P> matrix_;
  bool extended_;
  bool fixed_afterwards_;
  std::array<Extension, P> extensions_{};  ///< by the functions between the tied one and the end of the grid
  Extension left_extension_{}, right_extension_{};
  std::array<double, P + 1> left_row_{}, right_row_{};
  bool fixed_left_ = false, fixed_right_ = false, tied_left_ = false, tied_right_ = false;
  std::size_t touched_begin_ = 0, touched_end_ = 0;  ///< functions that touch material
  std::size_t begin_ = 0, end_ = 0;                  ///< unknowns of the system
};

}  // namespace hompm::detail
