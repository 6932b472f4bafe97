// Gauss–Legendre quadrature.
#pragma once

#include <vector>

namespace hompm::numerics {

/// Points in (0, 1), ascending, and weights with sum 1.
struct GaussRule {
  std::vector<double> points;
  std::vector<double> weights;
};

/// The rule with n ≥ 1 points, exact for polynomials of degree 2n − 1: roots of the Legendre polynomial by
/// Newton's method on its three-term recurrence (Abramowitz & Stegun 25.4.29). Throws `Error` for n < 1.
GaussRule gauss_legendre(int n);

}  // namespace hompm::numerics
