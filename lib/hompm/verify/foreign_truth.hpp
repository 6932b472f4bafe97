// What another code's results are held against: a golden folder, a scene file or a built-in case, and the
// exact solution of its scene at the particles of anybody's results.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <hompm/reference/reference.hpp>
#include <hompm/scene/scene.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/verify/message_log.hpp>
#include <hompm/verify/particle_table.hpp>

namespace hompm::detail {

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
