// A polynomial switch.
#pragma once

namespace hompm::numerics {

/// 0 for x ≤ 0, 1 for x ≥ 1, between them x⁵ (126 − 420 x + 540 x² − 315 x³ + 70 x⁴): the polynomial of least
/// degree that joins both with four continuous derivatives.
inline double smooth_step(double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  return x * x * x * x * x * (126.0 + x * (-420.0 + x * (540.0 + x * (-315.0 + x * 70.0))));
}

/// What of a load acts at `time` (s) that grows smoothly over `ramp_time` (s); all of it where that is 0.
inline double ramp(double time, double ramp_time) {
  return ramp_time > 0.0 ? smooth_step(time / ramp_time) : 1.0;
}

}  // namespace hompm::numerics
