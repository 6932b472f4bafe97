#include <algorithm>

#include <hompm/error.hpp>
#include <hompm/numerics/cubic_spline.hpp>

namespace hompm::numerics {

CubicSplineSites::CubicSplineSites(std::size_t sites) : count_(sites) {
  if (sites < fewest_sites) throw Error("a spline needs at least two sites");
  for (auto* array : {&sites_, &width_, &inverse_width_, &eliminate_, &inverse_pivot_, &above_})
    array->resize(sites);
}

// Unknowns are the second derivatives M_1 … M_{n−2} at the inner sites; not-a-knot gives M_0 and M_{n−1} from
// them:
//   M_0 = (1 + h_0/h_1) M_1 − (h_0/h_1) M_2, and its mirror image.
std::size_t CubicSplineSites::factorise(std::span<const double> sites) {
  std::copy(sites.begin(), sites.end(), sites_.begin());
  const std::size_t intervals = count_ - 1;
  const double* x = sites_.data();
  double* width = width_.data();
  double* inverse_width = inverse_width_.data();
  bool ascending = true;
  for (std::size_t i = 0; i < intervals; ++i) {
    width[i] = x[i + 1] - x[i];
    inverse_width[i] = 1.0 / width[i];
    ascending &= width[i] > 0.0;
  }
  if (!ascending)
    for (std::size_t i = 0;; ++i)
      if (!(width[i] > 0.0)) return i + 1;
  if (count_ < 4) return 0;

  const std::size_t last = count_ - 2;
  double* eliminate = eliminate_.data();
  double* inverse_pivot = inverse_pivot_.data();
  double* above = above_.data();
  const auto diagonal = [width](std::size_t i) { return 2.0 * (width[i - 1] + width[i]); };
  const double left = width[0] * inverse_width[1];
  const double right = width[last] * inverse_width[last - 1];
  double inverse = 1.0 / (diagonal(1) + width[0] * (1.0 + left));
  inverse_pivot[1] = inverse;
  above[1] = width[1] - width[0] * width[0] * inverse_width[1];
  const auto eliminate_row = [&](std::size_t i, double below, double on_diagonal) {
    const double factor = below * inverse;
    inverse = 1.0 / (on_diagonal - factor * above[i - 1]);
    eliminate[i] = factor;
    inverse_pivot[i] = inverse;
    above[i] = width[i];
  };
  for (std::size_t i = 2; i < last; ++i) eliminate_row(i, width[i - 1], diagonal(i));
  eliminate_row(last, width[last - 1] - width[last] * width[last] * inverse_width[last - 1],
                diagonal(last) + width[last] * (1.0 + right));
  return 0;
}

void CubicSplineSites::fit(std::span<const double> values, Fit& spline) const {
  spline.values = values;
  std::vector<double>& result = spline.second_derivatives;
  if (count_ == 2) {
    result[0] = result[1] = 0.0;
    return;
  }
  const auto slope = [&](std::size_t i) { return (values[i + 1] - values[i]) * inverse_width_[i]; };
  if (count_ == 3) {
    const double curvature = 2.0 * (slope(1) - slope(0)) / (width_[0] + width_[1]);
    result[0] = result[1] = result[2] = curvature;
    return;
  }
  const std::size_t last = count_ - 2;
  const double* y = values.data();
  const double* inverse_width = inverse_width_.data();
  const double* eliminate = eliminate_.data();
  const double* above = above_.data();
  const double* inverse_pivot = inverse_pivot_.data();
  double* m = result.data();
  double before = slope(1);
  double reduced = 6.0 * (before - slope(0));
  m[1] = reduced;
  for (std::size_t i = 2; i <= last; ++i) {
    const double after = (y[i + 1] - y[i]) * inverse_width[i];
    reduced = 6.0 * (after - before) - eliminate[i] * reduced;
    m[i] = reduced;
    before = after;
  }
  double next = reduced * inverse_pivot[last];
  m[last] = next;
  for (std::size_t i = last - 1; i >= 1; --i) {
    next = (m[i] - above[i] * next) * inverse_pivot[i];
    m[i] = next;
  }
  const double left = width_[0] * inverse_width_[1];
  const double right = width_[last] * inverse_width_[last - 1];
  result[0] = (1.0 + left) * result[1] - left * result[2];
  result[last + 1] = (1.0 + right) * result[last] - right * result[last - 1];
}

void CubicSplineSites::slopes(const Fit& spline, std::span<double> result) const {
  const std::size_t last = count_ - 1;
  const double* y = spline.values.data();
  const double* curvature = spline.second_derivatives.data();
  const double* width = width_.data();
  const double* inverse_width = inverse_width_.data();
  double* slope_at = result.data();
  for (std::size_t i = 0; i < last; ++i)
    slope_at[i] = (y[i + 1] - y[i]) * inverse_width[i] -
                  width[i] * (1.0 / 6.0) * (2.0 * curvature[i] + curvature[i + 1]);
  slope_at[last] = slope(last, spline);
}

}  // namespace hompm::numerics
