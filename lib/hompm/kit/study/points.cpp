#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <hompm/kit/scene_file/keys.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/study/study.hpp>
#include <hompm/scheme/scheme.hpp>

namespace hompm::study {
namespace {

std::size_t rank(const std::string& key) {
  static const std::array<std::string, 8> order{"scheme.name",
                                                "scheme.degree",
                                                "scheme.time_integrator",
                                                "scheme.cells",
                                                "scheme.particles_per_cell",
                                                "scheme.time_step",
                                                "scheme.courant",
                                                "scheme.step_fraction"};
  return static_cast<std::size_t>(std::find(order.begin(), order.end(), key) - order.begin());
}

std::string value_at(const std::vector<Setting>& settings, const std::string& key) {
  for (const Setting& setting : settings)
    if (setting.key == key) return setting.value;
  return "";
}

/// The row of schemes of a point under way; the standard one where nothing names it.
const Scheme* row_of(const std::vector<Setting>& said, const std::vector<Setting>& fixed) {
  std::string name = value_at(said, "scheme.name");
  if (name.empty()) name = value_at(fixed, "scheme.name");
  if (name.empty()) name = "tielen2017";
  for (const Scheme& scheme : scheme_table())
    if (scheme.name == name) return &scheme;
  return nullptr;
}

/// `all`, `first-order` or `higher-order`; nothing for another word.
std::optional<std::vector<std::string>> schemes_meant(const std::string& word) {
  if (word != "all" && word != "first-order" && word != "higher-order") return std::nullopt;
  std::vector<std::string> names;
  for (const Scheme& scheme : scheme_table()) {
    const bool first = scheme.choices.time_integrator == TimeIntegrator::euler_cromer;
    if (word == "all" || first == (word == "first-order")) names.push_back(scheme.name);
  }
  return names;
}

/// What a value of an axis stands for; itself, mostly.
std::vector<std::string> meant(const std::string& key, const std::string& value, const Scheme* row) {
  if (key == "scheme.name") return schemes_meant(value).value_or(std::vector{value});
  if (value != "all") return {value};
  std::vector<std::string> values;
  if (row == nullptr) return values;
  if (key == "scheme.degree")
    for (int degree = row->lowest_degree; degree <= row->highest_degree; ++degree)
      values.push_back(std::to_string(degree));
  if (key == "scheme.time_integrator") {
    const TimeIntegrator own = row->choices.time_integrator;
    values.push_back(detail::find_key(key)->rule.words.at(static_cast<std::size_t>(own)));
    if (own == TimeIntegrator::leapfrog) values.emplace_back("blanes-moan");
  }
  return values;
}

std::string name_of(const std::vector<Setting>& settings) {
  std::string name;
  for (const auto& [key, value, where] : settings)
    name += (name.empty() ? "" : ",") + short_key(key) + "=" + value;
  return name.empty() ? "as-it-is" : name;
}

void expand(const Study& study, const Sweep& sweep, std::vector<Setting>& said,
            const std::function<void(const std::vector<Setting>&)>& take) {
  if (said.size() == sweep.size()) return take(said);
  const Axis& axis = sweep[said.size()];
  for (const std::string& value : axis.values)
    for (const std::string& one : meant(axis.key, value, row_of(said, study.settings))) {
      said.push_back({axis.key, one, axis.where});
      expand(study, sweep, said, take);
      said.pop_back();
    }
}

Scene load(const Study& study, const std::vector<Setting>& settings) {
  std::vector<Override> overrides;
  for (const auto* list : {&study.settings, &settings})
    for (const auto& [key, value, where] : *list)
      overrides.push_back({key, value, where.empty() ? short_key(key) + "=" + value : where});
  return study.scene_file.empty() ? load_builtin(study.case_name, study.variant, overrides)
                                  : load_scene(study.scene_file, overrides);
}

}  // namespace

Sweep in_order(Sweep sweep) {
  std::sort(sweep.begin(), sweep.end(), [](const Axis& a, const Axis& b) {
    return std::pair(rank(a.key), a.key) < std::pair(rank(b.key), b.key);
  });
  return sweep;
}

std::vector<Point> points_of(const Study& study) {
  constexpr std::size_t most = 10000;
  std::size_t count = 0;
  std::vector<Point> points;
  std::set<std::string> names;
  for (const Sweep& unordered : study.sweeps) {
    const Sweep sweep = in_order(unordered);
    std::vector<Setting> said;
    expand(study, sweep, said, [&](const std::vector<Setting>& settings) {
      if (++count > most)
        throw SceneError(Origin{"sweeps"}, "more than " + std::to_string(most) +
                                               " points: take fewer values, or part the study in several");
      std::string name = name_of(settings);
      if (names.insert(name).second) points.push_back({std::move(name), settings});
    });
  }
  return points;
}

Scene scene_of(const Study& study, const Point& point) { return load(study, point.settings); }

std::vector<Point> checked_points(const Study& study) {
  load(study, {});
  std::vector<Point> points = points_of(study);
  std::map<std::pair<std::string, std::string>, SceneError> complaints;  // by key and value
  std::set<std::pair<std::string, std::string>> accepted;
  for (const Point& point : points) {
    try {
      scene_of(study, point);
      for (const auto& [key, value, where] : point.settings) accepted.insert({key, value});
    } catch (const SceneError& error) {
      for (const auto& [key, value, where] : point.settings) complaints.try_emplace({key, value}, error);
    }
  }
  for (const auto& [value, complaint] : complaints)
    if (!accepted.contains(value)) throw SceneError(complaint);
  return points;
}

}  // namespace hompm::study
