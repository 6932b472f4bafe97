#include <hompm/error.hpp>
#include <hompm/numerics/floating_point.hpp>

namespace hompm::numerics {
namespace {

// Each operand is volatile so that the machine computes at run time what the rest of the library computes at
// run time.
double contracted(double a, double b) { return a * a - b; }
double reassociated(double a, double b) { return (a + b) - a; }

constexpr auto contracts = "this build contracts a*b + c into one rounding; build with -ffp-contract=off";
constexpr auto reorders = "this build reorders sums or keeps extra digits; build without -ffast-math";

}  // namespace

void check_floating_point() {
  // First, for another rounding mode looks like some of the faults below.
  const volatile double one = 1.0;
  const volatile double just_above_half_ulp = 0x1.8p-53;
  const volatile double just_below_half_ulp = 0x1.8p-54;
  if (one + just_above_half_ulp != 1.0 + 0x1p-52 || one + just_below_half_ulp != 1.0 ||
      -one - just_above_half_ulp != -1.0 - 0x1p-52 || -one - just_below_half_ulp != -1.0)
    throw ArithmeticError("the rounding mode is not to nearest");

  const volatile double near_one = 1.0 + 0x1p-27;
  const volatile double square = 1.0 + 0x1p-26;  // near_one² rounded; the exact product has 2⁻⁵⁴ more
  if (contracted(near_one, square) != 0.0)
    throw ArithmeticError(contracts);  // LCOV_EXCL_LINE: a cell of tests/reproducibility

  const volatile double tiny = 0x1p-60;
  if (reassociated(one, tiny) != 0.0)
    throw ArithmeticError(reorders);  // LCOV_EXCL_LINE: a cell of tests/reproducibility

  const volatile double smallest_normal = 0x1p-1022;
  const volatile double half = 0.5;
  if (smallest_normal * half == 0.0)
    throw ArithmeticError("subnormal numbers are flushed to zero here; build without -ffast-math");
}

}  // namespace hompm::numerics
