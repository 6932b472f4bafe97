// The column of the law `rate` under a load switched on at once, by the method of characteristics.
#pragma once

#include <hompm/reference/reference.hpp>

namespace hompm {

/// A body at rest, fixed at X = 0 and free at X = L, of the law σ = E (1 − 1/λ), from t = 0 under a constant
/// acceleration.
struct GasColumn {
  double length;        ///< m
  double density;       ///< kg/m³, undeformed
  double wave_speed;    ///< m/s, c = √(E/ρ0)
  double acceleration;  ///< m/s², in +X
};

/// Fields of the column as a function of time (s, not decreasing) and reference positions (m, ascending).
///
/// Seen by a freely falling observer the law is that of an isothermal gas at rest whose base starts to move:
/// with w = v − bt, y = x − bt²/2 the quantity w − c ln λ stays the same on the curves dy/dt = w + c, and w +
/// c ln λ on dy/dt = w − c (derived in docs/method.md). The loads' kink travels along one such curve, back
/// and forth. On a net of these curves, laid so that the kink is one of them, w and λ are therefore known
/// without error; the net itself is integrated by the trapezoidal rule, with 1, 2, 4 and 8 times `curves`
/// curves per round trip of a wave, and extrapolated (Romberg) to the 8th order, which the kink does not
/// spoil.
///
/// `curves` ≥ 8. The function throws `Error` when time decreases, and when it is asked for a time at which
/// curves of one family have met: a shock has formed, and no smooth solution exists.
struct GasColumnSolution {
  FieldsAt at;
  std::function<double(double time)> kink;  ///< its place, m
};
GasColumnSolution gas_column(const GasColumn& column, int curves, const ReferenceWatch& watch = {});

}  // namespace hompm
