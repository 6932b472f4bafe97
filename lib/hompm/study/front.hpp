// Which settings are worth their cost: the Pareto front, and the cheapest for an error.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace hompm::study {

/// A run as far as a choice is concerned. Both are finite and ≥ 0.
struct Candidate {
  double cost = 0.0;
  double error = 0.0;
};

/// Indices of the candidates that no other beats in cost and error alike, by rising cost and falling error.
/// Of equal ones the first.
std::vector<std::size_t> pareto_front(std::span<const Candidate> candidates);

/// Index of the cheapest candidate with at most this error, of equal ones the most accurate; nothing where
/// none is as accurate.
std::optional<std::size_t> cheapest(std::span<const Candidate> candidates, double error);

}  // namespace hompm::study
