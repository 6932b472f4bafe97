#include <array>
#include <cmath>
#include <string>

#include <hompm/error.hpp>
#include <hompm/numerics/spline_space.hpp>

namespace hompm::numerics {
namespace {

constexpr int max_degree = 5;
using Polynomial = std::array<double, max_degree + 1>;

/// (a + b s) · q
Polynomial times_linear(const Polynomial& q, double a, double b) {
  Polynomial product{};
  for (std::size_t i = 0; i < q.size(); ++i) {
    product[i] += a * q[i];
    if (i + 1 < q.size()) product[i + 1] += b * q[i];
  }
  return product;
}

/// Cox–de Boor recursion (de Boor, A Practical Guide to Splines, ch. IX) with knots at whole numbers: the
/// functions cell … cell + degree restricted to the cell, as polynomials of x − `about`.
std::vector<Polynomial> pieces_on_cell(int degree, int cells, int cell, int about) {
  const auto knot = [&](int i) { return static_cast<double>(std::clamp(i - degree, 0, cells)); };
  std::vector<Polynomial> functions(static_cast<std::size_t>(degree) + 1);
  functions.back()[0] = 1.0;  // degree 0: only the function whose span is this cell
  for (int k = 1; k <= degree; ++k) {
    for (int local = degree - k; local <= degree; ++local) {
      const int i = cell + local;
      Polynomial sum{};
      const auto add = [&sum](const Polynomial& p) {
        for (std::size_t power = 0; power < sum.size(); ++power) sum[power] += p[power];
      };
      const auto at = static_cast<std::size_t>(local);
      if (const double width = knot(i + k) - knot(i); width > 0.0)
        add(times_linear(functions[at], (about - knot(i)) / width, 1.0 / width));
      if (local < degree)
        if (const double width = knot(i + k + 1) - knot(i + 1); width > 0.0)
          add(times_linear(functions[at + 1], (knot(i + k + 1) - about) / width, -1.0 / width));
      functions[at] = sum;
    }
  }
  return functions;
}

}  // namespace

SplineSpace::SplineSpace(int degree, int cells, double origin, double cell_width)
    : degree_(degree),
      cells_(cells),
      origin_(origin),
      cell_width_(cell_width),
      inverse_width_(1.0 / cell_width),
      shared_(std::max(0, cells - 2 * (degree - 1) - 1)) {
  if (degree < 1 || degree > max_degree)
    throw Error("a spline space has degree 1 … 5, not " + std::to_string(degree));
  if (cells < 1) throw Error("a spline space has at least one cell, not " + std::to_string(cells));
  if (!(cell_width > 0.0) || !std::isfinite(cell_width)) throw Error("the cell width must be above zero");

  const int distinct = cells - shared_;
  const auto piece_size = 2 * static_cast<std::size_t>(degree + 1) * static_cast<std::size_t>(degree + 1);
  pieces_.resize(static_cast<std::size_t>(distinct) * piece_size);
  for (int piece = 0; piece < distinct; ++piece) {
    const int cell = piece < degree ? piece : cells - distinct + piece;
    double* coefficient = &pieces_[static_cast<std::size_t>(piece) * piece_size];
    for (const int about : {cell, cell + 1}) {
      const auto functions = pieces_on_cell(degree, cells, cell, about);
      for (std::size_t power = 0; power < functions.size(); ++power)
        for (const Polynomial& function : functions) *coefficient++ = function[power];
    }
  }
}

void SplineSpace::evaluate(Location at, std::span<double> values, std::span<double> gradients) const {
  switch (degree_) {
    case 1: return evaluate<1>(at, values.data(), gradients.data());
    case 2: return evaluate<2>(at, values.data(), gradients.data());
    case 3: return evaluate<3>(at, values.data(), gradients.data());
    case 4: return evaluate<4>(at, values.data(), gradients.data());
    default: return evaluate<5>(at, values.data(), gradients.data());
  }
}

}  // namespace hompm::numerics
