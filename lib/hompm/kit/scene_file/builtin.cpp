#include <algorithm>
#include <string>
#include <vector>

#include <hompm/kit/scene_file/embedded_cases.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/scene_file/value_rule.hpp>

namespace hompm {
namespace {

template <class Predicate>
std::vector<std::string> names(Predicate wanted, std::string BuiltinScene::*name) {
  std::vector<std::string> found;
  for (const BuiltinScene& scene : builtin_scenes()) {
    if (wanted(scene) && (found.empty() || found.back() != scene.*name)) found.push_back(scene.*name);
  }
  return found;
}

[[noreturn]] void unknown(const std::string& option, const std::string& word, const std::string& what,
                          const std::vector<std::string>& candidates) {
  const std::string near = nearest(word, candidates);
  const std::string hint =
      near.empty() ? "there are " + detail::listed(candidates) : "did you mean " + near + '?';
  throw SceneError(Origin{option + ' ' + detail::printable(word), 0, 0}, "unknown " + what + "; " + hint);
}

}  // namespace

const std::vector<BuiltinScene>& builtin_scenes() {
  static const std::vector<BuiltinScene> scenes = [] {
    std::vector<BuiltinScene> all;
    for (const detail::EmbeddedCase& embedded : detail::embedded_cases()) {
      const std::size_t dash = embedded.name.find('-');
      const std::string variant = dash == std::string::npos ? "" : embedded.name.substr(dash + 1);
      // The large-strain variant is what the method is for.
      all.push_back({embedded.name.substr(0, dash), variant, variant == "large", embedded.text});
    }
    return all;
  }();
  return scenes;
}

Scene load_builtin(const std::string& case_name, const std::string& variant,
                   const std::vector<Override>& overrides) {
  const auto of_case = [&](const BuiltinScene& scene) { return scene.case_name == case_name; };
  const auto& scenes = builtin_scenes();
  if (std::none_of(scenes.begin(), scenes.end(), of_case)) {
    unknown("--case", case_name, "case",
            names([](const BuiltinScene&) { return true; }, &BuiltinScene::case_name));
  }
  const auto scene = std::find_if(scenes.begin(), scenes.end(), [&](const BuiltinScene& candidate) {
    return of_case(candidate) && (variant.empty() ? candidate.is_default : candidate.variant == variant);
  });
  if (scene == scenes.end())
    unknown("--variant", variant, "variant of the case " + case_name, names(of_case, &BuiltinScene::variant));
  return parse_scene(scene->text, "built-in scene " + scene->case_name + '-' + scene->variant, overrides);
}

}  // namespace hompm
