#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include <hompm/kit/verify/exact.hpp>
#include <hompm/kit/verify/judge.hpp>
#include <hompm/number.hpp>
#include <hompm/numerics/floating_point.hpp>

namespace hompm {
namespace {

using OneSide = std::array<double, 5>;  // of values at 1 … 5 steps from a place

/// Weights at the place of the polynomial through them, and of its slope times the step.
constexpr OneSide value_weights{5.0, -10.0, 10.0, -5.0, 1.0};
constexpr OneSide slope_weights{-77.0 / 12.0, 107.0 / 6.0, -39.0 / 2.0, 61.0 / 6.0, -25.0 / 12.0};

double weighted(const OneSide& weights, const OneSide& values) {
  return std::inner_product(weights.begin(), weights.end(), values.begin(), 0.0);
}

void add_breaks(const Scene& scene, const Reference& reference, double time, std::vector<FieldBreak>& all) {
  constexpr double near = 1e-6;  // of the length
  const double length = scene.body.length;
  std::vector<double> places{scene.body.left()};
  for (const double place : reference.breaks(time))
    if (place - places.back() > near * length && scene.body.right() - place > near * length)
      places.push_back(place);
  places.push_back(scene.body.right());
  const double E = scene.material.youngs_modulus;
  const std::array scales{length, std::sqrt(E / scene.material.density), E};
  const std::array<std::string, 3> names{"displacement", "velocity", "stress"};
  double longest = 1e-3 * length;  // on each side, so short that waves of the start are polynomials
  for (const auto& field : {scene.initial_velocity, scene.initial_displacement})
    if (field) longest = std::min(longest, 1e-3 * length / field->mode);
  for (std::size_t k = 1; k + 1 < places.size(); ++k) {
    const double step =
        std::min({longest, (places[k] - places[k - 1]) / 6.0, (places[k + 1] - places[k]) / 6.0});
    std::vector<double> X;
    for (const int i : {-5, -4, -3, -2, -1, 1, 2, 3, 4, 5}) X.push_back(places[k] + i * step);
    const ReferenceFields fields = reference.at(time, X);
    double size = 0.0;  // of the motion, as a strain
    for (std::size_t f = 0; f < names.size(); ++f)
      for (const double value : fields.*point_fields[f]) size = std::max(size, std::abs(value) / scales[f]);
    for (std::size_t f = 0; f < names.size(); ++f) {
      const auto& values = fields.*point_fields[f];
      OneSide left{};
      OneSide right{};
      std::copy(values.rbegin() + 5, values.rend(), left.begin());
      std::copy(values.begin() + 5, values.end(), right.begin());
      const std::array value{weighted(value_weights, left), weighted(value_weights, right)};
      const std::array slope{-weighted(slope_weights, left) / step, weighted(slope_weights, right) / step};
      const double scale = size * scales[f];
      if (std::abs(value[1] - value[0]) > 1e-7 * scale)
        all.push_back({time, places[k], names[f], true, value[0], value[1]});
      else if (std::abs(slope[1] - slope[0]) * length > 1e-5 * scale)
        all.push_back({time, places[k], names[f], false, slope[0], slope[1]});
    }
  }
}

/// Throws `Error` where the solution is not good over the body.
void demand_sound(const Scene& scene, const Reference& reference, double time) {
  constexpr int count = 33;
  std::vector<double> X(count);
  for (int i = 0; i < count; ++i)
    X[static_cast<std::size_t>(i)] = scene.body.left() + scene.body.length * i / (count - 1);
  std::string reason;
  if (!detail::sound_fields(reference, time, X, reason))
    throw SceneError(Origin{"scene"}, "no exact solution at t = " + to_text(time) + " s: " + reason);
}

}  // namespace

namespace {

std::string number_text(double value) {
  return std::isnan(value) ? "nan" : std::isinf(value) ? "infinite" : to_text(value);
}

}  // namespace

std::string outside(const Scene& scene, const MaterialPoint& point) {
  const auto [time, X] = point;
  const double left = scene.body.left();
  const double right = scene.body.right();
  const double rounding =
      4.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(left), std::abs(right));
  if (!(time >= 0.0 && time <= scene.end_time))
    return "t = " + number_text(time) + " s is not within the run, 0 to " + to_text(scene.end_time) + " s";
  if (!(X >= left - rounding && X <= right + rounding))
    return "X = " + number_text(X) + " m is not in the body, " + to_text(left) + " to " + to_text(right) +
           " m";
  if (scene.rest && time < scene.end_time)
    return "t = " + to_text(time) +
           " s: the solution of a scene with [rest] is its state of rest, t = " + to_text(scene.end_time) +
           " s";
  return "";
}

ExactSolution exact_solution(const Scene& scene, std::span<const MaterialPoint> points) {
  numerics::check_floating_point();
  const std::optional<Reference> reference = make_reference(scene);
  if (!reference) throw SceneError(Origin{"scene"}, "no reference solution is known for this scene");
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return std::tuple(points[i].time, points[i].X, i); });
  for (const MaterialPoint& point : points)
    if (const std::string why = outside(scene, point); !why.empty()) throw SceneError(Origin{"scene"}, why);

  ExactSolution exact{.reference = reference->description, .fields = {}, .body_force = {}, .breaks = {}};
  if (reference->breaks) exact.breaks.emplace();
  for (const auto field : point_fields) (exact.fields.*field).resize(points.size());
  std::vector<double> X;
  for (std::size_t first = 0; first < order.size(); first += X.size()) {
    const double time = points[order[first]].time;
    X.clear();
    for (std::size_t i = first; i < order.size() && points[order[i]].time == time; ++i)
      X.push_back(std::clamp(points[order[i]].X, scene.body.left(), scene.body.right()));
    demand_sound(scene, *reference, time);
    if (exact.breaks) add_breaks(scene, *reference, time, *exact.breaks);
    const ReferenceFields fields = reference->at(time, X);
    if (reference->body_force) {
      exact.body_force.resize(points.size());
      const std::vector<double> forces = reference->body_force(time, X);
      for (std::size_t i = 0; i < X.size(); ++i) exact.body_force[order[first + i]] = forces[i];
    }
    for (const auto field : point_fields) {
      auto& error = exact.fields.error.*field;
      if (!(fields.error.*field).empty()) error.resize(points.size());
      for (std::size_t i = 0; i < X.size(); ++i) {
        (exact.fields.*field)[order[first + i]] = (fields.*field)[i];
        if (!error.empty()) error[order[first + i]] = (fields.error.*field)[i];
      }
    }
  }
  return exact;
}

}  // namespace hompm
