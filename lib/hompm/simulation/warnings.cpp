#include <algorithm>

#include <hompm/effects/registry.hpp>
#include <hompm/number.hpp>
#include <hompm/simulation/critical_step.hpp>
#include <hompm/simulation/resolution.hpp>
#include <hompm/simulation/warnings.hpp>

namespace hompm {
namespace {

/// A scene that divides by little.
bool grows_in_time(const Scene* body) {
  const SchemeSpec& scheme = body->scheme;
  return scheme.choices.sequence == Sequence::usl && scheme.degree == 1 && moving_free_end(*body);
}

double settled_from(const Scene& scene) {
  double latest = 0.0;
  for (const Scene* body : bodies_of(scene)) latest = std::max(latest, outlook(*body).settled_from);
  return latest;
}

}  // namespace

std::vector<Warning> warnings_before(const Scene& scene, const TimeStepping& stepping) {
  std::vector<Warning> warnings = scene.warnings;
  if (std::ranges::any_of(bodies_of(scene), grows_in_time))
    warnings.push_back(
        {"unstable-in-time",
         "scheme.sequence = \"usl\" with hat functions divides forces at a moving free end by next to no "
         "mass: long runs blow up at any step; \"musl\" was made for that, and degree 2 lasts longer"});
  for (const detail::Unresolved& found : detail::unresolved(scene, stepping.time_step))
    if (!found.refused) warnings.push_back({found.code, found.origin.text() + ": " + found.text});
  if (!scene.rest) return warnings;
  const double rest_from = std::max(settled_from(scene), scene.rest->earliest.value_or(0.0));
  if (rest_from >= scene.end_time)
    warnings.push_back(
        {"no-rest", "[rest] cannot be reached before the end time: " +
                        (rest_from > 1e300 ? "a load never stops changing; give it a duration"
                                           : "a load changes until " + to_text(rest_from) +
                                                 " s, or rest.earliest is then; end_time must be above")});
  return warnings;
}

std::vector<Warning> warnings_after(const RunExtremes& extremes, double scale) {
  std::vector<Warning> warnings;
  constexpr double small = 0.1;
  if (extremes.largest_strain > small)
    warnings.push_back(
        {"large-strain", "strains of up to " + to_text(extremes.largest_strain) +
                             " with material.law = \"linear\", which holds for small ones, up to about 0.1: "
                             "take \"hencky\" or \"neo-hookean\", or look at the units of load and modulus"});
  constexpr double of_rounding_and_step = 0.01;
  if (extremes.least_dissipated < -of_rounding_and_step * std::max(extremes.largest_energy, scale))
    warnings.push_back({"energy-made",
                        "what can only take energy (walls, contact, dampings, viscosities, plasticity) "
                        "gave " +
                            to_text(-extremes.least_dissipated) + " J/m^2 of the " +
                            to_text(extremes.largest_energy) +
                            " at work: take a smaller time step, or more particles per cell"});
  return warnings;
}

}  // namespace hompm
