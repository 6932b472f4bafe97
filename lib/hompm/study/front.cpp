#include <algorithm>
#include <numeric>
#include <tuple>

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

}  // namespace hompm::study
