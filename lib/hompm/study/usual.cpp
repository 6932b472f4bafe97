// The values that an axis takes when none are said.
#include <map>

#include <hompm/scene_file/content.hpp>
#include <hompm/study/study.hpp>

namespace hompm::study {
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
  if (equals != std::string::npos) axes.push_back({full_key(text.substr(0, equals), where), {}});
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
    axes.push_back({key, values->second});
  }
  return axes;
}

}  // namespace hompm::study
