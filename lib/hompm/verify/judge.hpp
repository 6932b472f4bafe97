// How far a run is from the exact solution of its scene.
#pragma once

#include <optional>
#include <span>
#include <string>

#include <hompm/reference/reference.hpp>
#include <hompm/scene/scene.hpp>
#include <hompm/simulation/run.hpp>
#include <hompm/verify/error_norms.hpp>

namespace hompm {

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
