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
  for (std::size_t i = 0; i + 1 < count_; ++i) {
    width_[i] = sites_[i + 1] - sites_[i];
    if (!(width_[i] > 0.0)) return i + 1;
    inverse_width_[i] = 1.0 / width_[i];
  }
  if (count_ < 4) return 0;

  const std::size_t last = count_ - 2;
  const auto diagonal = [&](std::size_t i) {
    double d = 2.0 * (width_[i - 1] + width_[i]);
    if (i == 1) d += width_[0] * (1.0 + width_[0] * inverse_width_[1]);
    if (i == last) d += width_[last] * (1.0 + width_[last] * inverse_width_[last - 1]);
    return d;
  };
  const auto below = [&](std::size_t i) {  // coupling of row i to M_{i−1}
    return i == last ? width_[i - 1] - width_[i] * width_[i] * inverse_width_[i - 1] : width_[i - 1];
  };
  for (std::size_t i = 1; i <= last; ++i) {
    double pivot = diagonal(i);
    if (i > 1) {
      eliminate_[i] = below(i) * inverse_pivot_[i - 1];
      pivot -= eliminate_[i] * above_[i - 1];
    }
    inverse_pivot_[i] = 1.0 / pivot;
    above_[i] = i == 1 ? width_[1] - width_[0] * width_[0] * inverse_width_[1] : width_[i];
  }
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
  double before = slope(0);
  double reduced = 0.0;
  for (std::size_t i = 1; i <= last; ++i) {
    const double after = slope(i);
    reduced = 6.0 * (after - before) - (i > 1 ? eliminate_[i] * reduced : 0.0);
    result[i] = reduced;
    before = after;
  }
  result[last] *= inverse_pivot_[last];
  for (std::size_t i = last - 1; i >= 1; --i)
    result[i] = (result[i] - above_[i] * result[i + 1]) * inverse_pivot_[i];
  const double left = width_[0] * inverse_width_[1];
  const double right = width_[last] * inverse_width_[last - 1];
  result[0] = (1.0 + left) * result[1] - left * result[2];
  result[last + 1] = (1.0 + right) * result[last] - right * result[last - 1];
}

}  // namespace hompm::numerics
