// The exact or reference solution of a scene at any points and times, with its jumps and kinks.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <hompm/reference/reference.hpp>

namespace hompm {

struct MaterialPoint {
  double time;  ///< s
  double X;     ///< m
};

/// Where a field jumps, or else its slope: a kink.
struct FieldBreak {
  double time, X;      ///< s, m
  std::string field;   ///< displacement, velocity, stress
  bool is_jump;        ///< else a kink
  double left, right;  ///< of a jump the values on both sides, of a kink the slopes ∂/∂X
};

struct ExactSolution {
  std::string reference;  ///< which solution
  /// One entry per point, in the order of the points. The error is empty for a closed form, whose only error
  /// is rounding; else the difference to a solution with half the resolution, an upper estimate.
  ReferenceFields fields;
  std::vector<double> body_force;  ///< m/s², of a manufactured solution at the points; else empty
  /// At the times asked for, by time and place; nothing where the solution does not know. Left out are those
  /// within a millionth of the body's length of an end or of each other. Values and slopes are those of the
  /// polynomials of the fourth degree through five points on each side.
  std::optional<std::vector<FieldBreak>> breaks;
};

/// Why the scene has no solution at a point, outside the body or the time of the run; "" where it has.
std::string outside(const Scene& scene, const MaterialPoint& point);

/// Points in any order. Throws `SceneError` where no solution is known, a point is outside, or the solution
/// is not good to 1e-3 over the body by its own account (a shock), and `ArithmeticError`.
ExactSolution exact_solution(const Scene& scene, std::span<const MaterialPoint> points);

}  // namespace hompm
