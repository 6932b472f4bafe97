#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <hompm/number.hpp>
#include <hompm/numerics/floating_point.hpp>
#include <hompm/simulation/critical_step.hpp>
#include <hompm/simulation/time_step.hpp>

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
  double shortest = std::numeric_limits<double>::infinity();  // time of a wave through a cell
  for (const Scene* body : bodies_of(scene)) {
    const double wave_speed = std::sqrt(body->material.youngs_modulus / body->material.density);
    shortest = std::min(shortest, *scheme.courant * (body->body.length / body->scheme.cells) / wave_speed);
  }
  return shortest;
}

}  // namespace

TimeStepping time_stepping(const Scene& scene) {
  numerics::check_floating_point();  // the search for the critical step already relies on it
  const std::string key = asked_by(scene.scheme);
  const auto said = scene.origins.find(key);
  const Origin origin = said != scene.origins.end() ? said->second : Origin{key};

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

  const double count = scene.end_time / asked;
  if (!(count <= 1e10)) throw SceneError(origin, key + ": that is more than 1e10 steps to the end time");
  // A quotient within rounding of a whole number means that number: the step asked for is then kept to the
  // bit.
  const double nearest = std::floor(count + 0.5);
  const bool whole = nearest >= 1.0 && std::abs(count - nearest) <= 1e-9 * nearest;
  const double steps = whole ? nearest : std::ceil(count);
  result.steps = static_cast<std::int64_t>(steps);
  result.time_step = whole ? asked : scene.end_time / steps;
  return result;
}

}  // namespace hompm
