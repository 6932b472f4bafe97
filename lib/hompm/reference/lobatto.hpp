// The nodes of a Legendre spectral element.
#pragma once

#include <span>
#include <vector>

namespace hompm {

/// Legendre–Gauss–Lobatto nodes on [−1, 1], ascending, and what belongs to them.
struct LobattoRule {
  std::vector<double> nodes;
  std::vector<double> weights;              ///< sum 2, exact to degree 2p − 1
  std::vector<double> barycentric_weights;  ///< up to a common factor
  /// derivative[i·(p+1) + j]: the derivative at node i of the polynomial that is 1 at node j and 0 at the
  /// others
  std::vector<double> derivative;

  /// Value at ξ in [−1, 1] of the polynomial with these values at the nodes, by the barycentric formula
  /// (Berrut & Trefethen 2004).
  [[nodiscard]] double interpolate(std::span<const double> values, double xi) const;
};

/// The rule of degree p ≥ 1, with p + 1 nodes: the ends and the extrema of the Legendre polynomial P_p, by
/// Newton's method (Canuto et al. 2006, section 2.3).
LobattoRule lobatto_rule(int degree);

}  // namespace hompm
