// The arithmetic that exact reproducibility rests on.
#pragma once

namespace hompm::numerics {

/// Throws `ArithmeticError`, which names the cause, when this build or process does not compute as IEEE 754
/// says in double precision with rounding to nearest: another rounding mode, products contracted into fused
/// multiply-adds, x/h as x·(1/h), sums in another order, numbers taken for finite or for positive zeros,
/// subnormal numbers flushed to zero, more than double precision (`FLT_EVAL_METHOD` other than 0), constants
/// read as float. Every run and every critical step calls it first; docs/reproducibility.md says how it is
/// tested.
void check_floating_point();

}  // namespace hompm::numerics
