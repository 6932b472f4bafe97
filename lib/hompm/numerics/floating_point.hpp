// The arithmetic that exact reproducibility rests on.
#pragma once

namespace hompm::numerics {

/// Throws `ArithmeticError` when this build or process does not compute as IEEE 754 says with rounding to
/// nearest: products contracted into fused multiply-adds, sums reassociated (fast-math), subnormal numbers
/// flushed to zero, extended precision, or another rounding mode. Every run and every critical step calls it
/// first.
void check_floating_point();

}  // namespace hompm::numerics
