// Elementary functions with the same bits on every machine. The C library's differ between versions and
// architectures, so nothing on the result path may call them; only its sqrt is exact.
#pragma once

namespace hompm::numerics {

/// π rounded to the nearest double.
inline constexpr double pi = 3.141592653589793;

/// sin(x), cos(x), exp(x), evaluated with 113 bits (Boost.Multiprecision) and rounded once. Slow
/// (microseconds): for initial fields and reference solutions, not for the step loop.
double sin(double x);
double cos(double x);
double exp(double x);
/// sin(π x): the argument is multiplied by π in 106 bits or more, so sin_pi(1) is exactly 0. Fast enough for
/// the step loop.
double sin_pi(double x);
/// cos(π x), as slow as `cos`.
double cos_pi(double x);

/// Natural logarithm for x > 0, finite; evaluated in double-double arithmetic and rounded once. Fast enough
/// for the step loop.
double log(double x);

}  // namespace hompm::numerics
