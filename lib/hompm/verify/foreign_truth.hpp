// The exact solution of a golden folder's scene, at the particles of anybody's results.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <hompm/reference/reference.hpp>
#include <hompm/scene/scene.hpp>
#include <hompm/verify/foreign_table.hpp>
#include <hompm/verify/message_log.hpp>

namespace hompm::detail {

class ForeignTruth {
 public:
  /// Reads scene.toml of `folder`; without one, or when no solution is known, there is a note and no truth.
  /// Throws `FileError` and `SceneError`.
  ForeignTruth(const std::filesystem::path& folder, MessageLog& notes);

  [[nodiscard]] bool is_known() const { return reference_.has_value(); }
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

 private:
  void note(const std::string& text) { notes_.add(folder_, text, 0, text); }

  std::string folder_;
  MessageLog& notes_;
  std::optional<Scene> scene_;
  std::optional<Reference> reference_;
  double own_error_ = 0.0;
};

}  // namespace hompm::detail
