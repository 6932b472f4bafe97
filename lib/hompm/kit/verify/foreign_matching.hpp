// The parts of a comparison with another code's results: which times and particles belong together, what is
// exact, and which mistake would explain a difference.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/verify/foreign_comparison.hpp>
#include <hompm/kit/verify/particle_table.hpp>

namespace hompm::detail {

/// A time of B and how to get it from A.
struct TimeMatch {
  double time = 0.0;            ///< in B, s
  std::vector<double> sources;  ///< in A: one, or up to four around it to interpolate between
};

/// Finds each of `wanted` (ascending times of B) among the times of A: to `tolerance` (s), or between others
/// where `interpolate`. Times that cannot be had are faults of A and left out; where A ends within 1 % before
/// the last of several, a note.
std::vector<TimeMatch> match_times(ParticleTable& a, std::span<const double> wanted, double tolerance,
                                   bool interpolate);

/// The particles of A at the time of the match: read, or by the cubic (parabola, line) through the sources.
/// `blocks` are those of the sources, in order. Faults when the particles are not the same at all sources.
ParticleBlock block_at(ParticleTable& a, const TimeMatch& match, std::span<const ParticleBlock> blocks);

/// Indices (A, B) of particles.
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// The particles of the same body, where both sides tell, and X, to a thousandth of the smallest distance in
/// B, or of `cell` (m) where B has one particle. Particles without a counterpart are faults of A, or notes
/// where none is `needed`.
Pairs match_particles(ParticleTable& a, const ParticleBlock& mine, const ParticleBlock& golden, double cell,
                      bool needed);

/// One sentence for each mistake that explains most of a difference: units, signs, a column that holds
/// another field, times off by a step, velocities off by half a one, few digits, another amplitude, other
/// particles. `times_a` and `times_b` (s, ascending) are those of the file and those looked for.
std::vector<std::string> mistakes(const ForeignComparison& found, const std::vector<double>& times_a,
                                  const std::vector<double>& times_b, const std::optional<Scene>& scene);

/// The scene of a golden folder, a scene file, or the built-in case of that name (bar, bar-small). Throws
/// `FileError` when `b` is none of the three, and `SceneError`.
Scene scene_of(const std::filesystem::path& b, const std::vector<Override>& overrides);

class ForeignTruth {
 public:
  /// Reads the scene; without one, or when no solution is known, there is a note and no truth. Throws
  /// `FileError` when `b` is none of the three, and `SceneError`.
  ForeignTruth(const std::filesystem::path& b, MessageLog& notes);

  /// Whether `b` is a folder, which holds results.
  [[nodiscard]] bool has_results() const { return has_results_; }
  [[nodiscard]] bool is_known() const { return reference_.has_value(); }
  [[nodiscard]] const std::optional<Scene>& scene() const { return scene_; }
  /// Whether the scene runs to rest: its exact solution then is that of rest.
  [[nodiscard]] bool ends_at_rest() const { return scene_ && scene_->rest; }
  [[nodiscard]] std::string description() const { return reference_ ? reference_->description : ""; }
  /// The largest so far, relative L2 of the displacement.
  [[nodiscard]] double own_error() const { return own_error_; }

  /// Whether such a scene had come to rest when its results end, at `last` (s), before the end time.
  [[nodiscard]] bool is_at_rest(double last) const;

  /// Exact fields at the particles of a block; nothing, with a note about `whose`, where there are none.
  /// Times must not decrease from call to call.
  std::optional<ReferenceFields> at(const std::string& whose, const ParticleBlock& block);
  /// Exact fields at `X` (m, ascending) at eight times from the first to the last of the scene, where they
  /// are known: what is small at one time, as in a body that swings, is held against the largest of all.
  [[nodiscard]] std::vector<ReferenceFields> overview(const std::vector<double>& X) const;

 private:
  void note(const std::string& text) { notes_.add(name_, text, 0, text); }

  std::string name_;
  MessageLog& notes_;
  bool has_results_ = false;
  std::optional<Scene> scene_;
  std::optional<Reference> reference_;
  double own_error_ = 0.0;
};

}  // namespace hompm::detail
