#include <hompm/numerics/taylor_least_squares.hpp>

namespace hompm::numerics {

TaylorLeastSquares::TaylorLeastSquares(std::size_t sites, const SplineSpace& grid)
    : grid_(grid), inverse_width_(1.0 / grid.cell_width()), place_(3 * sites), pieces_(sites) {}

std::size_t TaylorLeastSquares::factorise(std::span<const double> sites) {
  for (std::size_t i = 1; i < sites.size(); ++i)
    if (!(sites[i] > sites[i - 1])) return i;
  // The first site alone in its cell, or the last, goes with the others next to it.
  const auto cell_of = [&](std::size_t i) { return grid_.locate(sites[i]).cell; };
  const auto goes_on = [&](std::size_t i) {
    return i == 1 || i + 1 == sites.size() || cell_of(i) == cell_of(i - 1);
  };
  count_ = 0;
  double* place = place_.data();
  for (std::size_t i = 0; i < sites.size(); ++count_) {
    const double start = grid_.breakpoint(cell_of(i));
    std::size_t begin = i;
    do ++i;
    while (i < sites.size() && goes_on(i));
    std::size_t end = i;
    if (end - begin == 1 && begin > 0 && end < sites.size()) {
      --begin;
      ++end;
    }
    for (std::size_t k = begin; k < end; ++k) place[k - begin] = (sites[k] - start) * inverse_width_;
    pieces_[count_] = {
        begin, end, start,
        orthogonal_quadratics(
            end - begin, [&](std::size_t k) { return place[k]; }, [](std::size_t) { return 1.0; })};
    place += end - begin;
  }
  return 0;
}

void TaylorLeastSquares::fit(std::span<const double> values, Fit& fit) const {
  const double* place = place_.data();
  for (std::size_t piece = 0; piece < count_; ++piece) {
    const auto& [begin, end, start, basis] = pieces_[piece];
    std::array<double, 3> sum{};
    for (std::size_t i = begin; i < end; ++i, ++place) {
      sum[0] += values[i];
      sum[1] += values[i] * basis.q1(*place);
      sum[2] += values[i] * basis.q2(*place);
    }
    for (std::size_t k = 0; k < 3; ++k) fit.coefficients[piece][k] = sum[k] * basis.inverse_norm[k];
  }
}

std::size_t TaylorLeastSquares::factorise_and_fit(std::span<const double> sites,
                                                  std::span<const double> values, Fit& result) {
  const std::size_t bad = factorise(sites);
  if (bad == 0) fit(values, result);
  return bad;
}

}  // namespace hompm::numerics
