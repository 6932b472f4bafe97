// Distance of a computed field from the exact one, over the particles.
#pragma once

#include <span>

namespace hompm {

struct ErrorNorms {
  double relative_l2 =
      0.0;  ///< ‖num − exact‖₂ / ‖exact‖₂; 0 when both vanish, the rms when only the exact field does
  double rms = 0.0;  ///< √(Σ (num − exact)² / N), in the unit of the field
  double max = 0.0;  ///< largest |num − exact|, in the unit of the field
};

/// Both spans have one entry per particle. The sums run in the order of the particles, so the bits are
/// reproducible. A NaN among the values makes all three NaN, so that no bound on any of them can hold. All
/// zero for no particles. Throws `Error` when the lengths differ.
ErrorNorms error_norms(std::span<const double> numerical, std::span<const double> exact);

}  // namespace hompm
