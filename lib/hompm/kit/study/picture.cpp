#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <hompm/kit/output/gnuplot.hpp>
#include <hompm/kit/study/answers.hpp>

namespace hompm::study {
namespace {

using gnuplot::Curve;
using gnuplot::Decades;
using gnuplot::Stroke;

struct Ranges {
  Decades cost, error;
};

Ranges ranges_of(const std::vector<Outcome>& outcomes, Cost cost) {
  constexpr double none = std::numeric_limits<double>::infinity();
  Decades costs{none, 0.0};
  Decades errors{none, 0.0};
  for (const Field field : all_fields)
    for (const auto& [price, error] : choice_of(outcomes, field, cost).candidates) {
      if (!(price > 0.0 && error > 0.0)) continue;
      costs = {std::min(costs.from, price), std::max(costs.to, price)};
      errors = {std::min(errors.from, error), std::max(errors.to, error)};
    }
  if (costs.to == 0.0) return {{1.0, 10.0}, {1e-3, 1.0}};  // nothing but failures
  return {gnuplot::decades(costs.from, costs.to), gnuplot::decades(errors.from, errors.to)};
}

Curve curve(const std::string& title, const Stroke& stroke, const std::vector<Candidate>& rows) {
  Curve drawn{title, stroke, {}, {}};
  for (const auto& [cost, error] : rows) {
    drawn.x.push_back(cost);
    drawn.y.push_back(error);
  }
  return drawn;
}

/// The front of a choice, as points.
std::vector<Candidate> front(const Choice& choice) {
  std::vector<Candidate> rows;
  for (const std::size_t i : pareto_front(choice.candidates)) rows.push_back(choice.candidates[i]);
  return rows;
}

/// Failed points of a scheme at the upper edge.
std::vector<Candidate> failures(const std::vector<Outcome>& outcomes, const std::string& scheme, Cost cost,
                                const Ranges& ranges) {
  std::vector<Candidate> rows;
  for (const Outcome& outcome : outcomes)
    if (outcome.record.scheme == scheme && outcome.record.status != Status::ok)
      rows.push_back({std::clamp(cost_of(outcome, cost).value_or(0.0), ranges.cost.from, ranges.cost.to),
                      ranges.error.to});
  return rows;
}

double floor_of(const std::vector<Outcome>& outcomes, Field field) {
  double highest = 0.0;
  for (const Outcome& outcome : outcomes)
    if (const auto error = error_of(outcome, field)) highest = std::max(highest, error->reference);
  return highest;
}

/// Many lines on top of each other: those of schemes that are in no field among the most accurate are grey.
bool is_grey(const std::vector<Outcome>& outcomes, const std::string& scheme, Cost cost) {
  constexpr int many = 8;
  constexpr int few = 4;
  const auto schemes = schemes_in(outcomes);
  if (schemes.size() <= many) return false;
  return std::ranges::none_of(all_fields, [&](Field field) {
    const Choice all = choice_of(outcomes, field, cost);
    const auto least = [&](const std::string& name) {
      double error = std::numeric_limits<double>::infinity();
      for (const Candidate& run : of_scheme(all, name).candidates) error = std::min(error, run.error);
      return error;
    };
    const double mine = least(scheme);
    return std::ranges::count_if(schemes, [&](const std::string& name) { return least(name) < mine; }) < few;
  });
}

gnuplot::Panel panel(const std::vector<Outcome>& outcomes, Field field, Cost cost, const Ranges& ranges) {
  const Choice all = choice_of(outcomes, field, cost);
  gnuplot::Panel panel{.title = to_string(field),
                       .x = {to_string(cost)},
                       .y = {"relative L2 error"},
                       .settings = "set logscale x\nset xtics autofreq\nset format x '10^{%T}'\n" +
                                   ranges.cost.range('x') + ranges.error.range('y'),
                       .logarithmic = true};
  const auto add = [&](const std::string& name, const Stroke& stroke, const std::vector<Candidate>& rows) {
    if (!rows.empty()) panel.curves.push_back(curve(name, stroke, rows));
  };
  add("best of all", {.colour = "#DDDDDD", .width = 7.0}, front(all));
  for (const bool grey : {true, false})  // below the others
    for (const std::string& scheme : schemes_in(outcomes)) {
      if (is_grey(outcomes, scheme, cost) != grey) continue;
      Stroke stroke = grey ? Stroke{.colour = "#AAAAAA"} : gnuplot::scheme_stroke(scheme);
      const Choice part = of_scheme(all, scheme);
      add("", {.colour = stroke.colour, .size = 0.2}, part.candidates);
      stroke.width = grey ? 1.0 : 1.5;
      stroke.size = grey ? 0.0 : 0.5;
      add(grey ? "others" : scheme, stroke, front(part));
      add("failed", {.colour = stroke.colour, .shape = 2, .size = 0.6},
          failures(outcomes, scheme, cost, ranges));
    }
  if (const double own = floor_of(outcomes, field); own > ranges.error.from)
    add("own error of the reference", {.colour = "#606060", .dash = 2, .width = 1.5},
        {{ranges.cost.from, own}, {ranges.cost.to, own}});
  return panel;
}

}  // namespace

std::string picture_script(const std::vector<Outcome>& outcomes, Cost cost, const std::string& title,
                           const std::string& name) {
  const Ranges ranges = ranges_of(outcomes, cost);
  gnuplot::Picture picture{.title = title, .panel_height = 250};
  for (const Field field : all_fields) picture.panels.push_back(panel(outcomes, field, cost, ranges));
  return gnuplot::script(picture, ".svg", name + ".svg") + gnuplot::script(picture, ".png", name + ".png");
}

}  // namespace hompm::study
