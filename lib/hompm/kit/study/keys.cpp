#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/scene_file/value_rule.hpp>
#include <hompm/kit/study/study.hpp>
#include <hompm/number.hpp>

namespace hompm::study {
namespace {

const std::string prefix = "scheme.";

std::string with_underscores(std::string text) {
  std::replace(text.begin(), text.end(), '-', '_');
  return text;
}

bool is_key(const std::string& key) {
  const auto& keys = scene_keys();
  return std::any_of(keys.begin(), keys.end(), [&](const SceneKey& known) { return known.path == key; });
}

}  // namespace

std::string full_key(const std::string& said, const std::string& where) {
  // Which effects and parameters there are depends on the scene; its reader tells.
  if (said == "scheme") return prefix + "name";
  if (said.starts_with("effect.") || said.starts_with("effect[")) return said;
  std::string key = with_underscores(said);
  if (is_key(key)) return key;
  if (is_key(prefix + key)) return prefix + key;
  std::vector<std::string> candidates{"scheme"};
  for (const SceneKey& known : scene_keys()) candidates.push_back(short_key(known.path));
  const std::string near = nearest(key, candidates);
  throw SceneError(Origin{where}, "no scene has a key `" + detail::printable(said) + "`" +
                                      (near.empty() ? "" : "; did you mean `" + near + "`?"));
}

std::string short_key(const std::string& key) {
  if (key == prefix + "name") return "scheme";
  return key.starts_with(prefix) ? key.substr(prefix.size()) : key;
}

std::string canonical_value(const std::string& said, const std::string& where) {
  const char* const end = said.data() + said.size();
  long long whole = 0;
  if (const auto [stop, error] = std::from_chars(said.data(), end, whole);
      error == std::errc{} && stop == end)
    return std::to_string(whole);
  double number = 0.0;
  if (const auto [stop, error] = std::from_chars(said.data(), end, number);
      error == std::errc{} && stop == end && std::isfinite(number))
    return to_text(number);
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.' || c == '+';
  };
  if (said.empty() || !std::all_of(said.begin(), said.end(), plain))
    throw SceneError(Origin{where}, "`" + detail::printable(said) + "` is neither a number nor a word");
  return said;
}

namespace {

using Values = std::vector<std::string>;

const std::map<std::string, Values>& usual_values() {
  static const std::map<std::string, Values> values{
      {"scheme.name", {"all"}},
      {"scheme.degree", {"all"}},
      {"scheme.time_integrator", {"all"}},
      {"scheme.cells", {"8", "16", "32", "64", "128"}},
      {"scheme.particles_per_cell", {"2", "4"}},
      {"scheme.courant", {"0.4", "0.2", "0.1", "0.05", "0.025"}},
      {"scheme.step_fraction", {"0.9", "0.5", "0.25", "0.1", "0.05"}}};
  return values;
}

}  // namespace

std::vector<Sweep> usual_sweeps() {
  const Axis particles{"scheme.particles_per_cell", {"2", "4"}};
  const Axis cells{"scheme.cells", {"4", "8", "16", "32", "64"}};
  const auto higher_order = [&](const std::string& integrator, const Values& courant) -> Sweep {
    return {{"scheme.name", {"higher-order"}},
            {"scheme.degree", {"all"}},
            {"scheme.time_integrator", {integrator}},
            cells,
            particles,
            {"scheme.courant", courant}};
  };
  return {{{"scheme.name", {"first-order"}},
           {"scheme.cells", {"8", "16", "32", "64", "128", "256"}},
           particles,
           {"scheme.courant", {"0.4", "0.1", "0.025"}}},
          higher_order("leapfrog", {"0.4", "0.1", "0.025"}),
          higher_order("blanes-moan", {"0.8", "0.4"})};
}

std::vector<Axis> read_axes(const std::string& text) {
  const std::string where = "--vary " + detail::printable(text);
  const auto equals = text.find('=');
  std::vector<Axis> axes;
  if (equals != std::string::npos) axes.push_back({full_key(text.substr(0, equals), where), {}, where});
  std::string rest = equals == std::string::npos ? text : text.substr(equals + 1);
  for (bool more = true; more;) {
    const auto comma = rest.find(',');
    more = comma != std::string::npos;
    const std::string word = rest.substr(0, comma);
    rest = more ? rest.substr(comma + 1) : "";
    if (equals != std::string::npos) {
      axes.back().values.push_back(canonical_value(word, where));
      continue;
    }
    const std::string key = full_key(word, where);
    const auto values = usual_values().find(key);
    if (values == usual_values().end())
      throw SceneError(Origin{where}, "which values? Say --vary " + short_key(key) + "=1,2,3");
    axes.push_back({key, values->second, where});
  }
  return axes;
}

}  // namespace hompm::study
