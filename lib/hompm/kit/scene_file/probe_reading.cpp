#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <hompm/kit/scene_file/reading.hpp>
#include <hompm/number.hpp>

namespace hompm::detail {
namespace {

/// Why the bodies have no such place; "" where they have.
std::string misplaced(const std::vector<const Scene*>& bodies, const ProbeSpec& probe) {
  const int places = (probe.X ? 1 : 0) + (probe.x ? 1 : 0) + (probe.end.empty() ? 0 : 1);
  if (places != 1) return "a probe is at exactly one of `X`, `x`, `end`, not " + std::to_string(places);
  if (bodies.size() > 1 && !probe.end.empty() && !probe.body)
    return "`body` of the probe is missing: there are " + std::to_string(bodies.size()) + " bodies with a " +
           probe.end + " end";
  std::string ranges;
  for (std::size_t body = 0; body < bodies.size() && probe.X; ++body) {
    if (std::cmp_not_equal(probe.body.value_or(static_cast<std::int64_t>(body)), body)) continue;
    const Body& at = bodies[body]->body;
    if (*probe.X >= at.left() && *probe.X <= at.right()) return "";
    ranges += ", " + to_text(at.left()) + " to " + to_text(at.right()) + " m";
  }
  return ranges.empty() ? ranges : "`X` of a probe must be in a body" + ranges + ", not " + to_text(*probe.X);
}

}  // namespace

void read_probes(Reading& reading) {
  const std::vector<const Scene*> bodies = bodies_of(reading.scene);
  const ValueRule place{.unit = "m"};
  const ValueRule end{.type = ValueType::word, .words = {"left", "right"}};
  const ValueRule body{
      .type = ValueType::integer, .minimum = 0.0, .maximum = static_cast<double>(bodies.size()) - 1.0};
  const ValueRule rows{.type = ValueType::integer, .minimum = 1.0, .maximum = 1e6};
  for (std::size_t index = 0; !reading.silent_on(list_path("probe", index)); ++index) {
    const std::string path = list_path("probe", index);
    const SaidValue& table = reading.said.values.at(path);
    if (!std::holds_alternative<TomlTable>(table.content)) {
      reading.report(table.value, "a probe must be a table, [[probe]], not " + shown(table.content));
      continue;
    }
    ProbeSpec probe;
    bool good = check_names_in(reading, path, {"X", "x", "end", "body", "rows"}, "a probe").empty();
    const auto take = [&](const std::string& name, const ValueRule& rule, auto store) {
      if (reading.silent_on(join_path(path, name))) return;
      const auto value = reading.take(join_path(path, name), '`' + name + "` of a probe", rule);
      good = good && value;
      if (value) store(*value);
    };
    take("X", place, [&](const Content& value) { probe.X = std::get<double>(value); });
    take("x", place, [&](const Content& value) { probe.x = std::get<double>(value); });
    take("end", end, [&](const Content& value) { probe.end = std::get<std::string>(value); });
    take("body", body, [&](const Content& value) { probe.body = std::get<std::int64_t>(value); });
    take("rows", rows, [&](const Content& value) { probe.rows = std::get<std::int64_t>(value); });
    const std::string wrong = good && reading.problems.empty() ? misplaced(bodies, probe) : "";
    if (!wrong.empty()) reading.report(reading.said.where(path + (probe.X ? ".X" : "")), wrong);
    reading.scene.probes.push_back(std::move(probe));
  }
}

std::string probe_text(const ProbeSpec& probe) {
  std::string text = "\n[[probe]]\n";
  if (probe.X) text += "X = " + toml_number(*probe.X) + "  # m\n";
  if (probe.x) text += "x = " + toml_number(*probe.x) + "  # m\n";
  if (!probe.end.empty()) text += "end = " + toml_string(probe.end) + "\n";
  if (probe.body) text += "body = " + std::to_string(*probe.body) + "\n";
  if (probe.rows) text += "rows = " + std::to_string(*probe.rows) + "\n";
  return text;
}

}  // namespace hompm::detail
