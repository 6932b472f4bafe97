// hompm-exact: the exact or reference solution of a scene at any points and times.
#include <cmath>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <hompm/kit/output/staging.hpp>
#include <hompm/kit/verify/exact.hpp>
#include <hompm/kit/verify/table.hpp>
#include <hompm/number.hpp>

#include "interruption.hpp"
#include "scene_run.hpp"

namespace hompm::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_points = 2'000'000;

Tool this_tool() {
  return {.name = "hompm-exact",
          .usage = "--case NAME|--scene FILE [options]",
          .about = "Prints the exact or reference solution of a scene at any points and times, as CSV.",
          .examples = {"hompm-exact --case column --at 0:1:101 --times 0.5,1",
                       "hompm-exact --case bar --points points.csv --output exact.csv",
                       "hompm-exact --case column --times 0:2.5:251 --jumps"},
          .topics = {{"scenes",
                      "whose solution; how it is discretised plays no part",
                      {"hompm-exact --scene my.toml --set material.youngs_modulus=2e5"},
                      scene_options({})},
                     {"points",
                      "where and when: all --at at all --times, or rows of a table; in any order",
                      {"hompm-exact --case column --at 1 --times 0:2.5:251"},
                      {{"at", "RANGE",
                        "X in m: FROM:TO:HOW-MANY, or a list 0,0.5,1 (default: 101 over the body)"},
                       {"times", "RANGE", "in s, as --at (default: the end time)"},
                       {"points", "FILE", "table with columns time and X"}}},
                     {"outputs",
                      "what is written",
                      {"hompm-exact --case column --times 0.5 --json"},
                      {{"output", "FILE", "in the place of standard output"},
                       {"jumps", "",
                        "in the place of the fields: where they, or their slopes, jump inside the "
                        "body at these times, with both sides"}}}},
          .remarks =
              "Exit codes: 0 fine, 2 bad usage, scene or point, or no solution is known, 5\n"
              "cannot read or write, 6 this build or process does not compute as IEEE 754 says.\n"};
}

[[noreturn]] void refuse_range(const std::string& where, const std::string& reason) {
  throw UsageError(where + ": " + reason + "; expected FROM:TO:HOW-MANY or a list, as in 0:1:101 or 0,0.5,1");
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

/// The numbers of --at or --times.
std::vector<double> range_of(const std::string& text, const std::string& option) {
  const std::string where = option + " " + text;
  std::vector<double> values;
  const std::vector<std::string> parts = split(text, ':');
  if (parts.size() == 1) {
    for (const std::string& part : split(text, ',')) values.push_back(parse_number(part, where));
    return values;
  }
  if (parts.size() != 3) refuse_range(where, "there are " + std::to_string(parts.size()) + " parts");
  const double from = parse_number(parts[0], where);
  const double width = parse_number(parts[1], where) - from;
  const std::uint64_t count = parse_count(parts[2], where);
  if (count < 2 || count > most_points || !std::isfinite(width))
    refuse_range(where, "it must be 2 to " + std::to_string(most_points) + " numbers");
  for (std::uint64_t i = 0; i + 1 < count; ++i)
    values.push_back(from + width * static_cast<double>(i) / static_cast<double>(count - 1));
  values.push_back(parse_number(parts[1], where));
  return values;
}

/// Throws `SceneError` for a point that is none of the scene's.
void demand_inside(const Scene& scene, const MaterialPoint& point, const std::string& where, int line = 0) {
  if (const std::string why = outside(scene, point); !why.empty())
    throw SceneError(Origin{where, line, line > 0 ? 1 : 0}, why);
}

std::vector<MaterialPoint> read_points(const Scene& scene, const std::string& file) {
  detail::MessageLog faults;
  detail::MessageLog notes;
  detail::Table table(file, {.fields = {"X"}, .lenient = true}, faults, notes);
  if (!table.has(0)) table.refuse(0, "it has no column X");
  std::vector<MaterialPoint> points;
  for (detail::Row row; table.next(row);) {
    points.push_back({row.key.time, table.value(row, 0)});
    if (points.size() > most_points)
      table.refuse(row.line, "there are more than " + std::to_string(most_points) + " points");
    if (faults.messages().empty()) demand_inside(scene, points.back(), file, static_cast<int>(row.line));
  }
  if (points.empty()) faults.add(file, "", 0, "it has no points");
  if (!faults.messages().empty()) throw SceneError(Origin{"--points"}, faults.messages().front());
  return points;
}

std::vector<MaterialPoint> points_of(const Scene& scene, const CommandLine& given) {
  if (given.has("points")) {
    given.refuse({"at", "times"}, "--points takes no");
    return read_points(scene, given.text("points"));
  }
  const std::string at = given.text("at");
  const std::string times = given.text("times");
  std::vector<double> X;
  for (int i = 0; i <= 100; ++i) X.push_back(scene.body.left() + scene.body.length * i / 100);
  if (given.has("at")) X = range_of(at, "--at");
  const std::vector<double> all_times =
      given.has("times") ? range_of(times, "--times") : std::vector{scene.end_time};
  for (const double x : X) demand_inside(scene, {scene.end_time, x}, "--at " + at);
  for (const double time : all_times) demand_inside(scene, {time, scene.body.left()}, "--times " + times);
  if (X.size() > most_points / all_times.size())
    throw UsageError("--at and --times: more than " + std::to_string(most_points) + " points in all");
  std::vector<MaterialPoint> points;
  for (const double time : all_times)
    for (const double x : X) points.push_back({time, x});
  return points;
}

struct Column {
  std::string name;
  std::vector<double> values;  ///< empty: not known
};

std::vector<Column> columns_of(const Scene& scene, std::span<const MaterialPoint> points,
                               const ExactSolution& exact) {
  const ReferenceFields& fields = exact.fields;
  std::vector<Column> columns{{"time", {}}, {"X", {}}, {"x", {}}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    columns[0].values.push_back(points[i].time);
    columns[1].values.push_back(points[i].X);
    columns[2].values.push_back(points[i].X + fields.displacement[i]);
  }
  const std::array<std::string, 4> names{"displacement", "velocity", "stress", "stretch"};
  Column density{"density", fields.stretch};
  for (double& value : density.values) value = scene.material.density / value;
  Column density_error{"density_error", fields.error.stretch};
  for (std::size_t i = 0; i < density_error.values.size(); ++i)
    density_error.values[i] *= density.values[i] / fields.stretch[i];
  for (std::size_t f = 0; f < names.size(); ++f) columns.push_back({names[f], fields.*point_fields[f]});
  columns.push_back(std::move(density));
  for (std::size_t f = 0; f < names.size(); ++f)
    columns.push_back({names[f] + "_error", fields.error.*point_fields[f]});
  columns.push_back(std::move(density_error));
  if (!exact.body_force.empty()) columns.push_back({"body_force", exact.body_force});
  return columns;
}

std::string csv_of(const std::vector<Column>& columns) {
  std::string text;
  for (const Column& column : columns) text += (text.empty() ? "" : ",") + column.name;
  text += "\n";
  for (std::size_t row = 0; row < columns.front().values.size(); ++row)
    for (const Column& column : columns) {
      if (!column.values.empty()) append_text(text, column.values[row]);
      text += &column == &columns.back() ? '\n' : ',';
    }
  return text;
}

Json jumps_json(const ExactSolution& exact) {
  Json jumps = exact.breaks ? Json::array() : Json();
  for (const FieldBreak& found : exact.breaks.value_or(std::vector<FieldBreak>()))
    jumps.push_back({{"time", found.time},
                     {"X", found.X},
                     {"field", found.field},
                     {"kind", found.is_jump ? "jump" : "kink"},
                     {"left", found.left},
                     {"right", found.right}});
  return jumps;
}

std::string jumps_csv(const Json& jumps) {
  std::string text = "time,X,field,kind,left,right\n";
  for (const Json& row : jumps)
    for (const auto& [name, value] : row.items())
      text += (value.is_string() ? value.get<std::string>() : to_text(value.get<double>())) +
              (name == "right" ? '\n' : ',');
  return text;
}

std::string json_text(const ExactSolution& exact, const std::vector<Column>& columns) {
  Json all{{"reference", exact.reference}, {"closed_form", exact.fields.error.displacement.empty()}};
  for (const Column& column : columns)
    all[column.name] = column.values.empty() ? Json() : Json(column.values);
  all["jumps"] = jumps_json(exact);
  return all.dump(2) + "\n";
}

int answer(const CommandLine& given) {
  const Scene scene = scene_of(given);
  const std::vector<MaterialPoint> points = points_of(scene, given);
  const ExactSolution exact = exact_solution(scene, points);
  if (given.has("jumps") && !exact.breaks)
    throw SceneError(Origin{"--jumps"}, "it is not known where this solution jumps: " + exact.reference);
  std::string text;
  if (given.has("json"))
    text = json_text(exact, columns_of(scene, points, exact));
  else if (given.has("jumps"))
    text = jumps_csv(jumps_json(exact));
  else
    text = csv_of(columns_of(scene, points, exact));
  if (given.has("output"))
    detail::write_whole(given.text("output"), text);
  else
    std::cout << text;
  return success;
}

}  // namespace
}  // namespace hompm::cli

int main(int argc, char** argv) {
  using namespace hompm::cli;
  catch_interruption("hompm-exact");
  return run_tool(this_tool(), argc, argv, answer);
}
