#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <hompm/number.hpp>
#include <hompm/numerics/floating_point.hpp>
#include <hompm/simulation/critical_step.hpp>
#include <hompm/simulation/time_step.hpp>
#include <hompm/simulation/warnings.hpp>

namespace hompm {
namespace {

std::string asked_by(const SchemeSpec& scheme) {
  if (scheme.time_step) return "scheme.time_step";
  return scheme.courant ? "scheme.courant" : "scheme.step_fraction";
}

double asked_step(const Scene& scene, double critical) {
  const SchemeSpec& scheme = scene.scheme;
  if (scheme.time_step) return *scheme.time_step;
  if (scheme.step_fraction) return *scheme.step_fraction * critical;
  if (!scheme.courant)
    throw SceneError(Origin{"scheme"},
                     "the time step is missing: give one of scheme.time_step (s), "
                     "scheme.courant, scheme.step_fraction");
  double shortest = std::numeric_limits<double>::infinity();  // time of a wave through a cell
  for (const Scene* body : bodies_of(scene)) {
    const double wave_speed = std::sqrt(body->material.youngs_modulus / body->material.density);
    shortest = std::min(shortest, *scheme.courant * (body->body.length / body->scheme.cells) / wave_speed);
  }
  return shortest;
}

struct Count {
  std::int64_t steps;
  bool whole;  ///< they end at the end time
};

/// How many steps it takes to the end time. A quotient within rounding of a whole number means that number:
/// the step asked for is then kept to the bit.
Count count_steps(const Scene& scene, double step, const Origin& origin, const std::string& key) {
  const double count = scene.end_time / step;
  if (!(count <= 1e10)) throw SceneError(origin, key + ": that is more than 1e10 steps to the end time");
  const double nearest = std::floor(count + 0.5);
  const bool whole = nearest >= 1.0 && std::abs(count - nearest) <= 1e-9 * nearest;
  return {static_cast<std::int64_t>(whole ? nearest : std::ceil(count)), whole};
}

}  // namespace

TimeStepping time_stepping(const Scene& scene) {
  numerics::check_floating_point();  // the search for the critical step already relies on it
  const std::string key = asked_by(scene.scheme);
  const Origin origin = scene.origin_of(key);

  TimeStepping result;
  result.critical_time_step = std::numeric_limits<double>::infinity();
  for (const Scene* body : bodies_of(scene))  // effects between bodies, which hold their ends, included
    result.critical_time_step = std::min(result.critical_time_step, critical_time_step(*body));
  const double asked = asked_step(scene, result.critical_time_step);
  if (asked > result.critical_time_step && !scene.scheme.allow_unstable)
    throw SceneError(origin, key + ": a time step of " + to_text(asked) +
                                 " s is above the critical step of " + scene.scheme.name + " here, " +
                                 to_text(result.critical_time_step) +
                                 " s (scheme.allow_unstable = true runs it all the same)");

  // Where next to nothing holds motions back, a part of the critical step says nothing.
  constexpr double longest_in_runs = 100.0;
  if (!scene.scheme.time_step && !(asked <= longest_in_runs * scene.end_time))
    throw SceneError(origin, key + ": that makes a time step of " +
                                 (std::isfinite(asked) ? to_text(asked) + " s" : "no end") +
                                 " for a run of " + to_text(scene.end_time) +
                                 " s: nothing in the body resists what the grid can move. Give "
                                 "scheme.time_step (s) instead, " +
                                 to_text(scene.end_time / 100.0) + " for a hundred steps");
  const Count count = count_steps(scene, asked, origin, key);
  result.steps = count.steps;
  result.time_step = count.whole ? asked : scene.end_time / static_cast<double>(count.steps);
  std::vector<Problem> too_fine;
  for (const detail::Unresolved& found : detail::unresolved(scene, result.time_step))
    if (found.refused) too_fine.push_back({found.origin, found.text});
  if (!too_fine.empty()) throw SceneError(std::move(too_fine));
  return result;
}

TimeStepping resumed_stepping(Scene& scene, double time_step) {
  TimeStepping result = time_stepping(scene);
  const Count count = count_steps(scene, time_step, Origin{"end_time"}, "end_time");
  result.steps = count.steps;
  result.time_step = time_step;
  if (!count.whole) {
    scene.end_time = static_cast<double>(count.steps) * time_step;
    for (Scene& body : scene.bodies) body.end_time = scene.end_time;
  }
  return result;
}

}  // namespace hompm
