// Any bytes are a scene or are refused in lines one can read; a scene that is written is read as the same
// scene. Nothing is run or written. Lines "#--set KEY=VALUE", comments to TOML, are the overrides.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/kit/scene_file/reader.hpp>

#include "demand.hpp"

namespace {

using namespace hompm;

std::vector<Override> overrides_in(const std::string& text) {
  const std::string mark = "#--set ";
  std::vector<Override> overrides;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find('=');
    if (!line.starts_with(mark) || equals == std::string::npos) continue;
    overrides.push_back(
        {line.substr(mark.size(), equals - mark.size()), line.substr(equals + 1), line.substr(1)});
  }
  return overrides;
}

std::optional<Scene> read(const std::string& text, const std::vector<Override>& overrides) {
  try {
    return parse_scene(text, "fuzz.toml", overrides);
  } catch (const SceneError& error) {
    demand(!error.problems().empty(), "an error tells a problem");
    for (const Problem& problem : error.problems()) demand(is_line(problem.message), problem.message);
    return std::nullopt;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::optional<Scene> scene = read(text, overrides_in(text));
  if (!scene) return 0;
  const std::string written = scene_text(*scene);
  const std::optional<Scene> again = read(written, {});
  demand(again.has_value(), "a written scene can be read:\n" + written);
  demand(scene_text(*again) == written, "a written scene is the same scene:\n" + written);
  return 0;
}
