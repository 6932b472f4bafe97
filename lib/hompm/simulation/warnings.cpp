#include <algorithm>
#include <cmath>
#include <optional>

#include <hompm/number.hpp>
#include <hompm/scene/amplitude.hpp>
#include <hompm/simulation/critical_step.hpp>
#include <hompm/simulation/warnings.hpp>

namespace hompm::detail {
namespace {

constexpr double fewest_steps = 4.0;
constexpr double enough_steps = 20.0;

class Search {
 public:
  Search(double time_step, std::vector<Unresolved>& found) : time_step_(time_step), found_(found) {}

  void load(const EffectSpec& spec, const Amplitude& amplitude) {
    if (amplitude.frequency > 0.0) time(spec, "the period of its frequency", 1.0 / amplitude.frequency, true);
    if (amplitude.duration > 0.0) time(spec, "its duration", amplitude.duration, true);
    if (amplitude.ramp_time > 0.0) time(spec, "its ramp_time", amplitude.ramp_time, false);
  }

  void field(const Scene& scene, const std::string& table, const std::optional<InitialField>& field) {
    if (!field || field->shape != "sine" || field->amplitude == 0.0) return;
    const double cells = scene.scheme.cells;
    const double particles = cells * scene.scheme.particles_per_cell;
    const double most = std::min(0.5 * particles, cells);
    if (field->mode <= most || field->mode == 1) return;
    found_.push_back({scene.origin_of(table + ".mode"), "coarse-mode",
                      "`" + table + ".mode` = " + std::to_string(field->mode) + ", half waves over " +
                          std::to_string(scene.scheme.cells) + " cells and " + to_text(particles) +
                          " particles: a wave takes two cells and four particles; take a mode of at most " +
                          to_text(std::floor(most)) + ", or more scheme.cells",
                      field->mode > particles});
  }

 private:
  void time(const EffectSpec& spec, const std::string& what, double duration, bool sampled) {
    const double steps = duration / time_step_;
    const double enough = sampled ? enough_steps : fewest_steps;
    if (steps >= enough * (1.0 - 1e-9)) return;
    found_.push_back({spec.origin, "coarse-load",
                      "the effect " + spec.type + ": " + what + ", " + to_text(duration) + " s, is " +
                          to_text(steps) + " time steps of " + to_text(time_step_) + " s" +
                          (sampled ? "" : ", which act as a jump") + "; take scheme.time_step = " +
                          to_text(duration / enough) + " or less, for " + to_text(enough) + " steps",
                      sampled && steps < fewest_steps});
  }

  double time_step_;
  std::vector<Unresolved>& found_;
};

}  // namespace

std::vector<Unresolved> unresolved(const Scene& scene, double time_step) {
  std::vector<Unresolved> found;
  Search search(time_step, found);
  for (const EffectSpec& spec : scene.effects) {
    const auto outlook = find_effect(scene, spec).outlook;
    if (outlook == nullptr || outlook(spec, scene).energy > 0.0) search.load(spec, amplitude_of(spec));
  }
  for (const Scene* body : bodies_of(scene)) {
    search.field(*body, "initial.velocity", body->initial_velocity);
    search.field(*body, "initial.displacement", body->initial_displacement);
  }
  return found;
}

}  // namespace hompm::detail

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
