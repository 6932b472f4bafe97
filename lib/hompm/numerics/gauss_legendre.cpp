#include <string>

#include <hompm/error.hpp>
#include <hompm/numerics/elementary.hpp>
#include <hompm/numerics/gauss_legendre.hpp>

namespace hompm::numerics {

GaussRule gauss_legendre(int n) {
  if (n < 1) throw Error("a Gauss rule has at least one point, not " + std::to_string(n));
  GaussRule rule{std::vector<double>(static_cast<std::size_t>(n)),
                 std::vector<double>(static_cast<std::size_t>(n))};
  for (int i = 0; i < (n + 1) / 2; ++i) {
    double z = cos_pi((i + 0.75) / (n + 0.5));
    double slope = 1.0;
    // Newton converges quadratically from this start: six rounds are past rounding for every n in use.
    for (int round = 0; round < 6; ++round) {
      double p = 1.0;
      double before = 0.0;
      for (int k = 1; k <= n; ++k) {
        const double next = ((2 * k - 1) * z * p - (k - 1) * before) / k;
        before = p;
        p = next;
      }
      slope = n * (z * p - before) / (z * z - 1.0);
      z -= p / slope;
    }
    if (2 * i + 1 == n) z = 0.0;
    const double weight = 1.0 / ((1.0 - z * z) * slope * slope);
    const auto low = static_cast<std::size_t>(i);
    const auto high = static_cast<std::size_t>(n - 1 - i);
    rule.points[low] = 0.5 - 0.5 * z;
    rule.points[high] = 0.5 + 0.5 * z;
    rule.weights[low] = weight;
    rule.weights[high] = weight;
  }
  return rule;
}

}  // namespace hompm::numerics
