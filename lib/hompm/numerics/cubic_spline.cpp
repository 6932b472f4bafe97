#include <algorithm>

#include <hompm/error.hpp>
#include <hompm/numerics/cubic_spline.hpp>

namespace hompm::numerics {

CubicSplineSites::CubicSplineSites(std::size_t sites) : count_(sites) {
  if (sites < fewest_sites) throw Error("a spline needs at least two sites");
  for (auto* array : {&sites_, &width_, &inverse_width_, &eliminate_, &inverse_pivot_, &above_})
    array->resize(sites);
}

/// Right-hand sides 6 (secant after − secant before) of the inner sites, reduced row by row.
class CubicSplineSites::Reduction {
 public:
  Reduction(const CubicSplineSites& sites, Fit& spline)
      : y_(spline.values.data()),
        inverse_width_(sites.inverse_width_.data()),
        m_(spline.second_derivatives.data()) {}

  void first_row() {
    before_ = secant(1);
    m_[1] = reduced_ = 6.0 * (before_ - secant(0));
  }
  void row(std::size_t i, double factor) {
    const double after = secant(i);
    m_[i] = reduced_ = 6.0 * (after - before_) - factor * reduced_;
    before_ = after;
  }

 private:
  [[nodiscard]] double secant(std::size_t i) const { return (y_[i + 1] - y_[i]) * inverse_width_[i]; }

  const double* y_;
  const double* inverse_width_;
  double* m_;
  double before_ = 0.0, reduced_ = 0.0;
};

// Unknowns are the second derivatives M_1 … M_{n−2} at the inner sites; not-a-knot gives M_0 and M_{n−1} from
// them:
//   M_0 = (1 + h_0/h_1) M_1 − (h_0/h_1) M_2, and its mirror image.
template <class Rows>
std::size_t CubicSplineSites::eliminate(std::span<const double> sites, Rows rows) {
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
  double* factors = eliminate_.data();
  double* inverse_pivot = inverse_pivot_.data();
  double* above = above_.data();
  const auto diagonal = [width](std::size_t i) { return 2.0 * (width[i - 1] + width[i]); };
  const double left = width[0] * inverse_width[1];
  const double right = width[last] * inverse_width[last - 1];
  double inverse = 1.0 / (diagonal(1) + width[0] * (1.0 + left));
  inverse_pivot[1] = inverse;
  above[1] = width[1] - width[0] * width[0] * inverse_width[1];
  rows.first_row();
  const auto eliminate_row = [&](std::size_t i, double below, double on_diagonal) {
    const double factor = below * inverse;
    inverse = 1.0 / (on_diagonal - factor * above[i - 1]);
    factors[i] = factor;
    inverse_pivot[i] = inverse;
    above[i] = width[i];
    rows.row(i, factor);
  };
  for (std::size_t i = 2; i < last; ++i) eliminate_row(i, width[i - 1], diagonal(i));
  eliminate_row(last, width[last - 1] - width[last] * width[last] * inverse_width[last - 1],
                diagonal(last) + width[last] * (1.0 + right));
  return 0;
}

std::size_t CubicSplineSites::factorise(std::span<const double> sites) {
  struct {
    void first_row() {}
    void row(std::size_t, double) {}
  } matrix_alone;
  return eliminate(sites, matrix_alone);
}

std::size_t CubicSplineSites::factorise_and_fit(std::span<const double> sites, std::span<const double> values,
                                                Fit& spline) {
  spline.values = values;
  const std::size_t bad = eliminate(sites, Reduction(*this, spline));
  if (bad == 0) substitute_back(spline);
  return bad;
}

void CubicSplineSites::fit(std::span<const double> values, Fit& spline) const {
  spline.values = values;
  if (count_ >= 4) {
    const double* factors = eliminate_.data();
    Reduction reduction(*this, spline);
    reduction.first_row();
    for (std::size_t i = 2; i <= count_ - 2; ++i) reduction.row(i, factors[i]);
  }
  substitute_back(spline);
}

void CubicSplineSites::substitute_back(Fit& spline) const {
  std::vector<double>& result = spline.second_derivatives;
  const auto secant = [&](std::size_t i) {
    return (spline.values[i + 1] - spline.values[i]) * inverse_width_[i];
  };
  if (count_ == 2) {
    result[0] = result[1] = 0.0;
    return;
  }
  if (count_ == 3) {
    const double curvature = 2.0 * (secant(1) - secant(0)) / (width_[0] + width_[1]);
    result[0] = result[1] = result[2] = curvature;
    return;
  }
  const std::size_t last = count_ - 2;
  const double* above = above_.data();
  const double* inverse_pivot = inverse_pivot_.data();
  double* m = result.data();
  double next = m[last] * inverse_pivot[last];
  m[last] = next;
  for (std::size_t i = last - 1; i >= 1; --i) {
    next = (m[i] - above[i] * next) * inverse_pivot[i];
    m[i] = next;
  }
  const double left = width_[0] * inverse_width_[1];
  const double right = width_[last] * inverse_width_[last - 1];
  m[0] = (1.0 + left) * m[1] - left * m[2];
  m[last + 1] = (1.0 + right) * m[last] - right * m[last - 1];
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
