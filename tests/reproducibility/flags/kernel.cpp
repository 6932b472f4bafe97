// The check of the arithmetic, then loops of the kind that the library has, whose bits are printed.
// run_flags.py compiles it with random flags. Exit code 6: refused.
#include <array>
#include <bit>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/numerics/band_ldlt.hpp>
#include <hompm/numerics/cubic_spline.hpp>
#include <hompm/numerics/floating_point.hpp>

namespace {

using Row = std::vector<double>;

void print(const char* name, const Row& row) {
  std::printf("%s", name);
  for (const double value : row) std::printf(" %016" PRIx64, std::bit_cast<std::uint64_t>(value));
  std::printf("\n");
}

/// n values in (0, 1), of all digits.
Row drawn(std::size_t n, std::uint64_t seed) {
  Row row(n);
  for (double& value : row) {
    seed = seed * 6364136223846793005U + 1442695040888963407U;
    value = static_cast<double>(seed >> 11U) * 0x1p-53;
  }
  return row;
}

Row quotients(const Row& x, double h) {
  Row result;
  for (const double value : x) result.push_back(value / h);
  for (const double value : x) result.push_back(value / 0.3 + h / value);
  for (const double value : x) result.push_back((value / h) / (1.0 + value) * 3.0 / 7.0);
  return result;
}

Row sums(const Row& x, const Row& y) {
  double sum = 0.0;
  double product = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i];
  for (std::size_t i = 0; i < x.size(); ++i) product += x[i] * y[i];
  for (const double value : x) square += (value - 0.1) * (value - 0.1);
  Row result{sum, product, std::sqrt(square), 1.0 / std::sqrt(square), sum / std::sqrt(product)};
  for (std::size_t i = 0; i < x.size(); ++i) result.push_back((x[i] + sum) - sum);
  for (std::size_t i = 0; i < x.size(); ++i) result.push_back(x[i] * y[i] - y[0] * x[i]);
  for (std::size_t i = 0; i < x.size(); ++i) result.push_back(x[i] - 0.1 * y[i]);
  return result;
}

/// Zeros with a sign, subnormal numbers, infinities, what is no number.
Row special(const Row& x) {
  Row result;
  const Row values{-0.0,
                   0x1p-1040,
                   0x1.8p-1022,
                   std::numeric_limits<double>::infinity(),
                   std::numeric_limits<double>::quiet_NaN(),
                   x[0]};
  for (const double value : values) {
    result.push_back(value + 0.0);
    result.push_back(0.0 - value);
    result.push_back(value * 0.5);
    result.push_back(!(value >= 0.0) ? 1.0 : 2.0);
    result.push_back(std::isfinite(value) ? 1.0 : 2.0);
    result.push_back(value < x[1] ? value : x[1]);
  }
  for (double& value : result)
    if (std::bit_cast<std::uint64_t>(value) << 1U > 0xffe0000000000000U)
      value = 3.0;  // no number: its bits are free
  return result;
}

/// The mass matrix of quadratic B-splines, and a solution with it.
Row mass_and_solution(const Row& x) {
  constexpr std::size_t cells = 12;
  hompm::numerics::BandLdlt<2> matrix(cells + 2);
  Row right(cells + 2);
  matrix.clear();
  for (const double part : x) {
    const double q = part * static_cast<double>(cells);
    const auto cell = static_cast<std::size_t>(q);
    const double s = q - static_cast<double>(cell);
    const std::array<double, 3> values{0.5 * (1.0 - s) * (1.0 - s), 0.75 - (s - 0.5) * (s - 0.5),
                                       0.5 * s * s};
    for (std::size_t i = 0; i < 3; ++i) {
      right[cell + i] += values[i] - 0.3 * part;
      for (std::size_t k = 0; k <= i; ++k) matrix.lower(cell + i, k) += values[i] * values[i - k] / 0.3;
    }
  }
  for (std::size_t i = 0; i < right.size(); ++i) matrix.lower(i, 0) += 0.01;
  if (matrix.factorise(0, right.size()) == right.size()) matrix.solve(0, right.size(), right);
  return right;
}

Row spline(const Row& x, const Row& y) {
  Row sites(x.size());
  double site = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sites[i] = site += 0.01 + x[i];
  hompm::numerics::CubicSplineSites splines(sites.size());
  hompm::numerics::CubicSplineSites::Fit fit(sites.size());
  Row result;
  if (splines.factorise_and_fit(sites, y, fit) != 0) return result;
  for (std::size_t i = 0; i < x.size(); ++i) {
    result.push_back(splines.evaluate(splines.weights(x[i] * site, 0), fit));
    result.push_back(splines.slope(i, fit));
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    hompm::numerics::check_floating_point();
  } catch (const hompm::ArithmeticError& error) {
    std::printf("%s\n", error.what());
    return 6;
  }
  // Numbers that no compiler knows.
  const Row x = drawn(67, static_cast<std::uint64_t>(argc));
  const Row y = drawn(67, static_cast<std::uint64_t>(argv[0][0]) * 0U + 7U);
  print("quotients", quotients(x, x[3] + 0.3));
  print("sums", sums(x, y));
  print("special", special(x));
  print("solution", mass_and_solution(x));
  print("spline", spline(x, y));
}
