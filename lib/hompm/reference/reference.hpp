// The solution a run is judged by: closed form where there is one, else the method of lines.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <hompm/scene/scene.hpp>

namespace hompm {

/// Values at given material points, one per point.
struct PointFields {
  std::vector<double> displacement;  ///< m
  std::vector<double> velocity;      ///< m/s
  std::vector<double> stress;        ///< Pa, with that of viscosities
  std::vector<double> stretch;       ///< λ
};

/// The members of `PointFields`.
inline constexpr std::array<std::vector<double> PointFields::*, 4> point_fields{
    &PointFields::displacement, &PointFields::velocity, &PointFields::stress, &PointFields::stretch};

/// Exact or reference fields.
struct ReferenceFields : PointFields {
  PointFields error;  ///< |difference| to the solution with half the resolution; empty for a closed form
};

/// Relative L2 error of each field.
struct ReferenceErrors {
  double displacement = 0.0;
  double velocity = 0.0;
  double stress = 0.0;
};

/// Fields at `time` (s) and reference positions `X` (m, ascending).
using FieldsAt = std::function<ReferenceFields(double time, std::span<const double> X)>;

/// Told now and then, while a reference solution is computed, which part of the work is done, 0 … 1; throws
/// to break off. May be empty.
using ReferenceWatch = std::function<void(double part)>;

struct Reference {
  std::string description;  ///< one line: which solution, from which source
  /// Times must not decrease from call to call. Throws `Error` where they do, and where no smooth solution
  /// exists.
  FieldsAt at;
  /// Own errors at the last call of `at`: the difference to a solution with half the resolution, which is an
  /// upper estimate. 0 for a closed form, and before the first call.
  std::function<ReferenceErrors()> estimated_error;
  bool steepens = false;  ///< its waves can become shocks: the law is not linear
  /// Where at a time (s) a field or its slope may jump inside the body (m, ascending); an empty function
  /// where that is not known.
  std::function<std::vector<double>(double time)> breaks = {};
  /// Of a manufactured solution the body force (m/s²) at a time (s) and X (m); else an empty function.
  std::function<std::vector<double>(double time, std::span<const double> X)> body_force = {};
};

/// The reference solution of a scene, or nothing where none is known (local damping before rest, say).
/// The same scene gives the same bits on every machine.
std::optional<Reference> make_reference(const Scene& scene, const ReferenceWatch& watch = {});

}  // namespace hompm
