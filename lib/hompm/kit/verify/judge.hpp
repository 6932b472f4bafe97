// How far a run is from the exact solution of its scene, over the particles.
#pragma once

#include <optional>
#include <span>
#include <string>

#include <hompm/reference/reference.hpp>
#include <hompm/simulation/run.hpp>

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

/// Errors of the last snapshot against the reference solution.
struct ErrorReport {
  std::string reference;             ///< which solution
  ReferenceErrors reference_errors;  ///< its own
  ErrorNorms displacement, velocity, stress;
};

/// The errors of `snapshot` against the scene's reference solution; nothing where the scene has none.
/// `reason` then says why. Throws nothing for a reference that ceases to exist (steepened to a shock): that
/// is a reason, too. What `watch` throws, is thrown.
std::optional<ErrorReport> judge(const Scene& scene, const RunResult& result, std::string& reason,
                                 const ReferenceWatch& watch = {});

namespace detail {

/// The reference fields at `time` (s) and `X` (m, ascending), where the reference is good to 1e-3 by its own
/// account; nothing otherwise, and `reason` says why.
std::optional<ReferenceFields> sound_fields(const Reference& reference, double time,
                                            std::span<const double> X, std::string& reason);

}  // namespace detail

}  // namespace hompm
