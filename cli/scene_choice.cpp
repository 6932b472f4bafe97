#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/verify/compare.hpp>
#include <hompm/number.hpp>

#include "scene_run.hpp"

namespace hompm::cli {
namespace {

namespace fs = std::filesystem;

/// Options that are short for `--set KEY=VALUE`.
const std::vector<std::pair<std::string, std::string>> shortcuts{
    {"scheme", "scheme.name"},
    {"degree", "scheme.degree"},
    {"cells", "scheme.cells"},
    {"particles-per-cell", "scheme.particles_per_cell"},
    {"time-step", "scheme.time_step"},
    {"courant", "scheme.courant"},
    {"step-fraction", "scheme.step_fraction"},
    {"end-time", "end_time"},
    {"snapshots", "output.snapshots"},
};

std::vector<Override> overrides_of(const CommandLine& given) {
  std::vector<Override> overrides;
  for (const auto& [option, key] : shortcuts)
    if (given.has(option))
      overrides.push_back({key, given.text(option), "--" + option + " " + given.text(option)});
  for (const auto& text : given.texts("probe")) overrides.push_back({"probe", text, "--probe " + text});
  for (const auto& text : given.texts("set")) {
    const auto [key, value] = key_and_value(text);
    overrides.push_back({key, value, "--set " + text});
  }
  // Rows of pixels.
  if (given.has("picture-xt") && !given.has("snapshots") && !given.has("check"))
    overrides.push_back({"output.snapshots", "200", "--picture-xt " + given.text("picture-xt")});
  for (const auto& text : given.texts("require")) {
    const auto [field, bound] = key_and_value(text, "--require", "FIELD=BOUND", "stress=1e-2");
    overrides.push_back({"require." + field, bound, "--require " + text});
  }
  return overrides;
}

}  // namespace

Scene scene_of(const CommandLine& given) {
  auto overrides = overrides_of(given);
  if (given.has("case") && given.has("scene")) throw UsageError("--case and --scene exclude each other");
  if (given.has("variant") && !given.has("case")) throw UsageError("--variant goes with --case");
  if (given.has("scene")) return load_scene(given.text("scene"), overrides);
  if (given.has("case")) return load_builtin(given.text("case"), given.text("variant"), overrides);
  if (given.has("check")) return load_scene(fs::path(given.text("check")) / "scene.toml", overrides);
  throw UsageError(
      "nothing to run: name a --case (bar, column), a --scene FILE, or (hompm-run) a golden folder to "
      "--check");
}

std::string first_different_line(const std::string& here, const std::string& there) {
  const auto [mine, theirs] = detail::first_different_lines(here, there);
  return "here `" + mine + "`, there `" + theirs + "`";
}

std::vector<Option> scene_options(const std::vector<Option>& more) {
  std::vector<Option> options{{"case", "NAME", "built-in case: bar, column"},
                              {"variant", "NAME", "variant of the case"},
                              {"scene", "FILE", "scene file instead of a case"},
                              {"set", "KEY=VALUE...", "set any key of the scene"},
                              {"end-time", "S", "end_time, s"}};
  options.insert(options.end(), more.begin(), more.end());
  return options;
}

void demand_same_scene(Scene& scene, const CommandLine& given) {
  const std::string folder = given.text("check");
  Scene golden = load_scene(fs::path(folder) / "scene.toml", {});
  golden.require = scene.require;
  const auto [snapshots, history] = golden.output;
  const bool among = scene.output.snapshots % snapshots == 0 && scene.output.history % history == 0;
  if (!among && !given.has("snapshots") && scene.origins.count("output.snapshots") == 0)
    scene.output = golden.output;
  Scene same = scene;
  if (among) same.output = golden.output;
  same.probes = golden.probes;
  const std::string mine = scene_text(same);
  const std::string theirs = scene_text(golden);
  if (mine == theirs) return;
  throw UsageError("--check " + folder +
                   ": a golden of another scene: " + first_different_line(mine, theirs));
}

Scene resumed_scene(const CommandLine& given, const Checkpoint& from) {
  const std::string option = "--resume " + given.text("resume");
  Scene scene = from.scene;
  if (given.has("case") || given.has("scene") || given.has("variant")) {
    scene = scene_of(given);
  } else if (const auto overrides = overrides_of(given); !overrides.empty()) {
    for (const Override& change : overrides)
      if (change.key != "end_time" && !change.key.starts_with("require."))
        throw UsageError(change.option +
                         ": --resume goes on with the scene in the checkpoint, of which only "
                         "end_time and [require] can be changed");
    scene = parse_scene(scene_text(from.scene), "scene in the checkpoint", overrides);
  }
  Scene before = from.scene;
  before.end_time = scene.end_time;
  before.require = scene.require;
  const std::string mine = scene_text(scene);
  const std::string theirs = scene_text(before);
  if (mine != theirs)
    throw UsageError(option + ": a checkpoint of another scene: " + first_different_line(mine, theirs));
  if (scene.end_time < from.scene.end_time)
    throw UsageError(option + ": end_time = " + to_text(scene.end_time) +
                     " is before that of the checkpoint, " + to_text(from.scene.end_time) +
                     " s; it can only become later");
  return scene;
}

}  // namespace hompm::cli
