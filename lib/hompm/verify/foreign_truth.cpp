#include <algorithm>

#include <hompm/number.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/verify/foreign_truth.hpp>
#include <hompm/verify/judge.hpp>

namespace hompm::detail {

ForeignTruth::ForeignTruth(const std::filesystem::path& folder, MessageLog& notes)
    : folder_(folder.string()), notes_(notes) {
  if (!std::filesystem::exists(folder / "scene.toml")) {
    note("there is no scene.toml to say what the exact solution is");
    return;
  }
  scene_ = load_scene((folder / "scene.toml").string(), {});
  reference_ = make_reference(*scene_);
  if (!reference_) note("no exact solution of its scene is known");
}

bool ForeignTruth::is_at_rest(double last) const {
  return ends_at_rest() && last < scene_->end_time * (1.0 - 1e-9);
}

std::optional<ReferenceFields> ForeignTruth::at(const std::string& whose, const ParticleBlock& block) {
  if (!reference_ || block.X.empty()) return std::nullopt;
  std::string reason;
  const Body& body = scene_->body;
  if (block.X.front() < body.left() || block.X.back() > body.right()) {
    reason = "there are particles outside of the body, " + to_text(body.left()) +
             " <= X <= " + to_text(body.right()) + " m";
  } else {
    auto exact = sound_fields(*reference_, block.time, block.X, reason);
    own_error_ = std::max(own_error_, reference_->estimated_error().displacement);
    if (exact) return exact;
  }
  note(whose + " is not held against the exact solution at time " + to_text(block.time) + ": " + reason);
  return std::nullopt;
}

}  // namespace hompm::detail
