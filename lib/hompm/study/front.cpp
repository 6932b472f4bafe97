#include <algorithm>
#include <numeric>
#include <tuple>

#include <hompm/numerics/elementary.hpp>
#include <hompm/study/front.hpp>

namespace hompm::study {

std::vector<std::size_t> pareto_front(std::span<const Candidate> candidates) {
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(candidates[a].cost, candidates[a].error) <
           std::tuple(candidates[b].cost, candidates[b].error);
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order)
    if (front.empty() || candidates[i].error < candidates[front.back()].error) front.push_back(i);
  return front;
}

std::optional<std::size_t> cheapest(std::span<const Candidate> candidates, double error) {
  for (const std::size_t i : pareto_front(candidates))
    if (candidates[i].error <= error) return i;
  return std::nullopt;
}

double PowerLaw::cost(double error) const { return factor * numerics::exp(-exponent * numerics::log(error)); }

std::optional<PowerLaw> fit(std::span<const Candidate> candidates) {
  const auto n = static_cast<double>(candidates.size());
  double sum_x = 0.0;
  double sum_y = 0.0;
  double sum_xx = 0.0;
  double sum_xy = 0.0;
  for (const auto& [cost, error] : candidates) {
    if (!(cost > 0.0 && error > 0.0)) return std::nullopt;
    const double x = numerics::log(error);
    const double y = numerics::log(cost);
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  const double spread = n * sum_xx - sum_x * sum_x;
  if (candidates.size() < 2 || !(spread > 1e-12 * n * sum_xx)) return std::nullopt;
  const double slope = (n * sum_xy - sum_x * sum_y) / spread;
  return PowerLaw{numerics::exp((sum_y - slope * sum_x) / n), -slope};
}

}  // namespace hompm::study
