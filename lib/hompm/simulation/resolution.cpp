#include <algorithm>
#include <cmath>

#include <hompm/effects/registry.hpp>
#include <hompm/number.hpp>
#include <hompm/scene/amplitude.hpp>
#include <hompm/simulation/resolution.hpp>

namespace hompm::detail {
namespace {

constexpr double fewest_steps = 4.0;
constexpr double enough_steps = 20.0;

Origin said_at(const Scene& scene, const std::string& key) {
  const auto said = scene.origins.find(key);
  return said == scene.origins.end() ? Origin{key} : said->second;
}

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
    found_.push_back({said_at(scene, table + ".mode"), "coarse-mode",
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
