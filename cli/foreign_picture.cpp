#include "foreign_picture.hpp"

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <hompm/number.hpp>

#include "child.hpp"
#include "common.hpp"

namespace hompm::cli {
namespace {

const std::map<std::string, std::string> units{{"displacement", "m"}, {"velocity", "m/s"}, {"stress", "Pa"}};
const gnuplot::Stroke look_of_a{.colour = "#D55E00", .size = 0.3};
const gnuplot::Stroke look_of_b{.colour = "#0072B2", .width = 2.0};
const gnuplot::Stroke look_of_exact{.colour = "#000000", .dash = 2, .width = 1.5};

std::vector<gnuplot::Curve> values(const ForeignCurves& curves) {
  return {{"B", look_of_b, curves.X_b, curves.b},
          {"A", look_of_a, curves.X_a, curves.a},
          {"exact", look_of_exact, curves.X_b, curves.exact_b}};
}

std::vector<gnuplot::Curve> errors(const ForeignCurves& curves, double scale) {
  std::vector<gnuplot::Curve> all;
  const auto add = [&](const char* title, const gnuplot::Stroke& look, const std::vector<double>& X,
                       std::vector<double> values, const std::vector<double>& exact) {
    if (exact.empty()) return;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::abs(values[i] - exact[i]) / scale;
    all.push_back({title, look, X, std::move(values)});
  };
  add("|A-B|", {.colour = "#009E73", .shape = 2, .size = 0.3}, curves.X_matched, curves.difference,
      std::vector<double>(curves.difference.size()));
  add("|B-exact|", {.colour = "#0072B2", .shape = 5, .size = 0.2}, curves.X_b, curves.b, curves.exact_b);
  add("|A-exact|", {.colour = "#D55E00", .size = 0.2}, curves.X_a, curves.a, curves.exact_a);
  return all;
}

gnuplot::Picture picture_of(const ForeignComparison& comparison, const std::string& title) {
  std::map<double, std::vector<gnuplot::Panel>> rows;
  std::vector<std::pair<std::string, gnuplot::Panel>> last;  // of each field
  for (std::size_t i = 0; i < comparison.curves.size(); ++i) {
    const auto& curves = comparison.curves[i];
    const auto unit = units.find(curves.field);
    if (unit == units.end()) continue;
    const std::string at = ", t = " + to_text(curves.time) + " s";
    const double scale = comparison.fields[i].scale;
    rows[curves.time].push_back({.title = curves.field + at,
                                 .x = {"X", "m"},
                                 .y = {curves.field, unit->second},
                                 .curves = values(curves)});
    if (last.empty() || last.back().first != curves.field) last.push_back({curves.field, {}});
    last.back().second = {.title = "errors" + at,
                          .x = {"X", "m"},
                          .y = {"error over " + gnuplot::readable(scale, unit->second)},
                          .logarithmic = true,
                          .curves = errors(curves, scale > 0.0 ? scale : 1.0)};
  }
  gnuplot::Picture picture{.title = title, .columns = last.size(), .panel_width = 260};
  // The start says little, and more than three rows are too small to see anything in.
  if (rows.size() > 1) rows.erase(0.0);
  std::size_t number = 0;
  for (auto& [time, panels] : rows) {
    if (rows.size() <= 3 || number == 0 || number == rows.size() / 2 || number + 1 == rows.size())
      picture.panels.insert(picture.panels.end(), panels.begin(), panels.end());
    ++number;
  }
  for (const auto& [field, panel] : last) picture.panels.push_back(panel);
  return picture;
}

}  // namespace

std::string draw_picture(const ForeignComparison& comparison, const std::string& a, const std::string& b,
                         const std::string& file) {
  const auto picture = picture_of(comparison, "A: " + a + ", B: " + b);
  if (picture.panels.empty()) return "there is no displacement, velocity or stress to draw";
  return draw(picture, file);
}

}  // namespace hompm::cli
