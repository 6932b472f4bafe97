#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/verify/foreign_matching.hpp>
#include <hompm/number.hpp>

namespace hompm::detail {
namespace {

namespace fs = std::filesystem;

/// The built-in scene that is called so: bar, bar-small.
Scene builtin(const std::string& name, const std::vector<Override>& overrides) {
  std::string names;
  for (const auto& scene : builtin_scenes()) {
    const std::string whole = scene.case_name + "-" + scene.variant;
    if (name == whole || (name == scene.case_name && scene.is_default))
      return load_builtin(scene.case_name, scene.variant, overrides);
    names += ", " + whole;
  }
  throw FileError("cannot compare with " + name +
                  ": there is no such folder or scene file, and the built-in cases are " + names.substr(2));
}

}  // namespace

Scene scene_of(const fs::path& b, const std::vector<Override>& overrides) {
  std::error_code none;
  const bool folder = fs::is_directory(b, none);
  const fs::path file = folder ? b / "scene.toml" : b;
  if (!folder && fs::exists(b, none) && b.extension() != ".toml")
    throw FileError("cannot compare with " + b.string() + ": it is not a folder, nor a scene file (.toml)");
  return folder || fs::exists(file, none) ? load_scene(file.string(), overrides)
                                          : builtin(b.string(), overrides);
}

ForeignTruth::ForeignTruth(const fs::path& b, MessageLog& notes) : name_(b.string()), notes_(notes) {
  std::error_code none;
  has_results_ = fs::is_directory(b, none);
  if (has_results_ && !fs::exists(b / "scene.toml", none)) {
    note("there is no scene.toml to say what the exact solution is");
    return;
  }
  scene_ = scene_of(b, {});
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
  if (!std::ranges::is_sorted(block.X)) {
    reason = "its bodies overlap";
  } else if (block.X.front() < body.left() || block.X.back() > body.right()) {
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

std::vector<ReferenceFields> ForeignTruth::overview(const std::vector<double>& X) const {
  std::vector<ReferenceFields> all;
  const auto reference = make_reference(*scene_);
  std::string reason;
  for (int part = 1; part <= 8; ++part) {
    auto fields = sound_fields(*reference, scene_->end_time * part / 8, X, reason);
    if (!fields) break;
    all.push_back(std::move(*fields));
  }
  return all;
}

}  // namespace hompm::detail
