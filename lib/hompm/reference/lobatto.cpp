#include <cstddef>

#include <hompm/numerics/elementary.hpp>
#include <hompm/reference/lobatto.hpp>

namespace hompm {
namespace {

struct LegendrePair {
  double current;   ///< P_p
  double previous;  ///< P_{p−1}
};

LegendrePair legendre(int degree, double x) {
  LegendrePair p{x, 1.0};
  for (int k = 2; k <= degree; ++k) {
    p = {((2.0 * k - 1.0) * x * p.current - (k - 1.0) * p.previous) / k, p.current};
  }
  return p;
}

}  // namespace

double LobattoRule::interpolate(std::span<const double> values, double xi) const {
  double numerator = 0.0;
  double denominator = 0.0;
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const double distance = xi - nodes[j];
    if (distance == 0.0) return values[j];
    const double share = barycentric_weights[j] / distance;
    numerator += share * values[j];
    denominator += share;
  }
  return numerator / denominator;
}

LobattoRule lobatto_rule(int degree) {
  const auto n = static_cast<std::size_t>(degree) + 1;
  LobattoRule rule{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n),
                   std::vector<double>(n * n)};
  for (std::size_t i = 0; 2 * i < n; ++i) {
    double x = 2 * i + 1 == n ? 0.0 : -numerics::cos_pi(static_cast<double>(i) / degree);
    // (1 − x²) P_p' = p (P_{p−1} − x P_p), whose derivative is −p (p+1) P_p: from these starting points
    // Newton's method has converged to rounding long before the tenth step.
    for (int newton = 0; newton < 10; ++newton) {
      const LegendrePair p = legendre(degree, x);
      x -= (x * p.current - p.previous) / ((degree + 1.0) * p.current);
    }
    const double p = legendre(degree, x).current;
    const std::size_t mirror = n - 1 - i;
    rule.nodes[i] = x;
    rule.nodes[mirror] = -x;
    rule.weights[i] = rule.weights[mirror] = 2.0 / (degree * (degree + 1.0) * p * p);
    rule.barycentric_weights[i] = 1.0 / p;
    rule.barycentric_weights[mirror] = degree % 2 == 0 ? 1.0 / p : -1.0 / p;
  }
  for (std::size_t i = 0; i < n; ++i) {
    double row_sum = 0.0;
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i) continue;
      const double entry =
          rule.barycentric_weights[j] / rule.barycentric_weights[i] / (rule.nodes[i] - rule.nodes[j]);
      rule.derivative[i * n + j] = entry;
      row_sum += entry;
    }
    rule.derivative[i * n + i] = -row_sum;  // a constant has no derivative
  }
  return rule;
}

}  // namespace hompm
