// Which settings are worth their cost: the Pareto front, the cheapest for an error, the law a front follows.
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

/// cost = factor · error^−exponent
struct PowerLaw {
  double factor = 0.0;
  double exponent = 0.0;
  [[nodiscard]] double cost(double error) const;
};

/// The law through the candidates, by least squares in the logarithms; nothing for fewer than two that differ
/// in error, or where a cost or error is 0.
std::optional<PowerLaw> fit(std::span<const Candidate> candidates);

}  // namespace hompm::study
