#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/numerics/floating_point.hpp>

namespace hompm::numerics {
namespace {

// What the compiler says of itself (g++ more than clang++). A probe below may miss what is done elsewhere.
#if defined(__FAST_MATH__)
constexpr bool fast_math = true;
#else
constexpr bool fast_math = false;
#endif
#if defined(__FINITE_MATH_ONLY__)
constexpr bool finite_only = __FINITE_MATH_ONLY__ != 0;
#else
constexpr bool finite_only = false;
#endif
#if defined(__ASSOCIATIVE_MATH__)
constexpr bool associative = true;
#else
constexpr bool associative = false;
#endif
#if defined(__RECIPROCAL_MATH__)
constexpr bool reciprocal = true;
#else
constexpr bool reciprocal = false;
#endif
#if defined(__NO_SIGNED_ZEROS__)
constexpr bool no_signed_zeros = true;
#else
constexpr bool no_signed_zeros = false;
#endif

/// A value that the compiler does not know, rounded to double: the machine computes at run time, as it does
/// in a run, and `a - b != 0` does not become `a != b`.
double unknown(double value) {
  const volatile double hidden = value;
  return hidden;
}

/// The first n values first, first + step, ..., unknown to the compiler.
std::array<double, 16> unknown_row(double first, double step) {
  std::array<double, 16> row{};
  for (double& value : row) {
    value = unknown(first);
    first += step;
  }
  return row;
}

double halved(double a) { return a * 0.5; }

bool has_float_constants() { return sizeof(0.1) != sizeof(double) || 0.1 == 0.1F; }

bool has_excess_precision() {
  // Rounded to 64 bits the sum is half-way between two doubles, and a second rounding goes the other way.
  const volatile double twice_rounded = unknown(1.0) + unknown(0x1p-53 + 0x1p-78);
  return FLT_EVAL_METHOD != 0 || twice_rounded == 1.0;
}

/// Each sum is rounded to double before it is compared, so that excess precision does not look like this.
bool rounds_otherwise() {
  const double one = unknown(1.0);
  const double up = unknown(0x1.8p-53);
  const double down = unknown(0x1.8p-54);
  return unknown(one + up) == 1.0 || unknown(one + down) != 1.0 || unknown(-one - up) == -1.0 ||
         unknown(-one - down) != -1.0;
}

/// a² rounded is b; the exact square has 2⁻⁵⁴ more. One use of the product: compilers contract within a
/// block.
bool contracts() {
  const double a = unknown(1.0 + 0x1p-27);
  const double b = unknown(1.0 + 0x1p-26);
  return unknown(a * a - b) != 0.0;
}

// Results are collected by calls that may throw: around these clang++ -O0 combines operations, too.

/// 49 k / 49 is k, but 49 · (1/49) is not 1.
bool divides_by_reciprocals() {
  if (reciprocal) return true;
  const double h = unknown(49.0);
  std::vector<double> quotients;
  double k = 0.0;
  for (const double x : unknown_row(49.0, 49.0)) quotients.push_back(x / 49.0);
  for (const double x : unknown_row(49.0, 49.0)) quotients.push_back(x / h);
  for (const double x : unknown_row(49.0, 49.0)) quotients.push_back(0.5 * (x / h) + 0.5 * (x / h));
  for (const double quotient : quotients) {
    k = k == 16.0 ? 1.0 : k + 1.0;
    if (quotient != k) return true;
  }
  return false;
}

bool reorders_sums() {
  const double one = unknown(1.0);
  double sum = one;
  std::vector<double> remainders;
  for (const double term : unknown_row(0x1p-53, 0.0)) {  // each too small, but not together
    sum += term;
    remainders.push_back((one + term) - one);
  }
  return associative || unknown(sum) != 1.0 || std::count(remainders.begin(), remainders.end(), 0.0) != 16;
}

bool forgets_signs_of_zeros() {
  std::vector<double> zeros;
  for (const double zero : unknown_row(-0.0, -0.0)) zeros.push_back(zero + 0.0);
  for (const double zero : unknown_row(0.0, 0.0)) zeros.push_back(0.0 - zero);
  return no_signed_zeros ||
         std::any_of(zeros.begin(), zeros.end(), [](double zero) { return std::signbit(zero); });
}

bool forgets_infinities() {
  const double nan = unknown(std::numeric_limits<double>::quiet_NaN());
  const double infinity = unknown(std::numeric_limits<double>::infinity());
  return finite_only || !(nan != nan) || !std::isnan(nan) || std::isfinite(infinity) ||
         !std::isinf(infinity) || infinity - infinity == 0.0;
}

/// At run time and where the compiler computes.
bool flushes_subnormals() {
  constexpr double smallest_normal = std::numeric_limits<double>::min();
  return unknown(smallest_normal) * unknown(0.5) == 0.0 || halved(smallest_normal) == 0.0;
}

bool approximates_roots() {
  for (const double k : unknown_row(1.0, 1.0))
    if (std::sqrt(k * k) != k) return true;
  return std::sqrt(unknown(2.0)) != 0x1.6a09e667f3bcdp+0 || std::sqrt(unknown(3.0)) != 0x1.bb67ae8584caap+0;
}

struct Probe {
  bool (*fails)();
  const char* message;
};

// The cause comes before what it may look like further down.
constexpr std::array probes{
    Probe{has_float_constants,
          "this build reads constants as float; build without -fsingle-precision-constant"},
    Probe{rounds_otherwise, "the rounding mode is not to nearest"},
    Probe{has_excess_precision,
          "this build computes in more than double precision (FLT_EVAL_METHOD is not 0); build for SSE2, as "
          "with -msse2 -mfpmath=sse, and not for the x87 unit"},
    Probe{[] { return fast_math; }, "this build may change results; build without -ffast-math and -Ofast"},
    Probe{contracts, "this build contracts a*b + c into one rounding; build with -ffp-contract=off"},
    Probe{
        reorders_sums,
        "this build reorders sums; build without -fassociative-math (part of -funsafe-math-optimizations and "
        "-ffast-math)"},
    Probe{divides_by_reciprocals,
          "this build computes x/h as x*(1/h); build without -freciprocal-math (part of "
          "-funsafe-math-optimizations and -ffast-math)"},
    Probe{forgets_infinities,
          "this build takes every number for finite; build without -ffinite-math-only (part of -ffast-math)"},
    Probe{
        forgets_signs_of_zeros,
        "this build takes -0 for 0; build without -fno-signed-zeros (part of -funsafe-math-optimizations and "
        "-ffast-math)"},
    Probe{flushes_subnormals,
          "subnormal numbers are flushed to zero here; build without -ffast-math and "
          "-fdenormal-fp-math, and link without -ffast-math and -mdaz-ftz"},
    Probe{approximates_roots, "square roots are not rounded to nearest here; build without -mrecip"},
};

}  // namespace

void check_floating_point() {
  for (const Probe& probe : probes)
    if (probe.fails()) throw ArithmeticError(probe.message);
}

}  // namespace hompm::numerics
