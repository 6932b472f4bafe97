// How far a run is from the exact solution of its scene, over the particles.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

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

/// Where the numbers of an `ErrorReport` come from.
enum class ErrorKind {
  exact,         ///< a closed form
  computed,      ///< a solution whose own error is known from its convergence, which is that of smooth fields
  extrapolated,  ///< the same, where it converges slowly or was refined once: its own error has a safety
                 ///< factor
};

/// What the snapshots of a run showed, for what its last one does not tell.
struct RunMotion {
  ReferenceErrors largest;    ///< the largest rms that each field had, in its unit
  std::size_t crossings = 0;  ///< of cells, by particles, from snapshot to snapshot

  /// Takes a snapshot of the scene's run; they come in the order of their times.
  void look(const Scene& scene, const Snapshot& snapshot);

 private:
  std::vector<double> cells_;  ///< of the particles at the last one
};

/// Errors of the last snapshot against the reference solution.
struct ErrorReport {
  std::string reference;             ///< which solution
  ReferenceErrors reference_errors;  ///< its own
  ErrorNorms displacement, velocity, stress;
  ErrorKind kind = ErrorKind::exact;
  /// What ‖num − true‖ is at most, over the size of the field: rms error and the reference's own, over the
  /// rms of the field. Where that is less than a tenth of the largest it had in the run, over this, and
  /// `notes` say so. A field that is as good as zero all the time (less than a thousandth of what the others
  /// make one expect) is held against that part of it.
  ReferenceErrors bound = {};
  std::vector<std::string> notes = {};  ///< for people
  bool jump = false;                    ///< the true stress has a jump or a front
  bool kink = false;                    ///< the slope of it has one, from particle to particle
  double cells_per_wave = 0.0;          ///< cells between two extrema of the true stress, on average
};

/// A field that is judged: where it is in each of these.
struct ErrorField {
  const char* name;
  const char* unit;
  std::vector<double> Snapshot::*values;
  std::vector<double> ReferenceFields::*exact;
  ErrorNorms ErrorReport::*norms;
  double ReferenceErrors::*error;
  std::optional<double> Requirement::*required;
};
inline constexpr std::array error_fields{
    ErrorField{"displacement", "m", &Snapshot::displacement, &ReferenceFields::displacement,
               &ErrorReport::displacement, &ReferenceErrors::displacement, &Requirement::displacement},
    ErrorField{"velocity", "m/s", &Snapshot::velocity, &ReferenceFields::velocity, &ErrorReport::velocity,
               &ReferenceErrors::velocity, &Requirement::velocity},
    ErrorField{"stress", "Pa", &Snapshot::stress, &ReferenceFields::stress, &ErrorReport::stress,
               &ReferenceErrors::stress, &Requirement::stress}};

/// The errors of `snapshot` against the scene's reference solution; nothing where the scene has none.
/// `reason` then says why. Throws nothing for a reference that ceases to exist (steepened to a shock): that
/// is a reason, too. What `watch` throws, is thrown.
std::optional<ErrorReport> judge(const Scene& scene, const RunResult& result, std::string& reason,
                                 const ReferenceWatch& watch = {}, const RunMotion& motion = {});

namespace detail {

/// The reference fields at `time` (s) and `X` (m, ascending), where the reference is good to 1e-3 by its own
/// account; nothing otherwise, and `reason` says why.
std::optional<ReferenceFields> sound_fields(const Reference& reference, double time,
                                            std::span<const double> X, std::string& reason);

/// √(Σ value² / N).
double rms(const std::vector<double>& values);

/// The report of a snapshot against fields at its particles, good to `own` (rms, in the units of the fields).
ErrorReport report_of(const Scene& scene, const Snapshot& snapshot, const ReferenceFields& fields,
                      const ReferenceErrors& own, const RunMotion& motion);

}  // namespace detail

}  // namespace hompm
