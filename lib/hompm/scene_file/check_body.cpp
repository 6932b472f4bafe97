// What the keys of a body demand of each other.
#include <hompm/effects/registry.hpp>
#include <hompm/scene_file/reading.hpp>

namespace hompm::detail {
namespace {

/// A grid that is said must reach beyond free ends, and cannot at fixed ones.
void check_grid(Reading& reading) {
  const Scene& scene = reading.scene;
  if (!reading.has("body.length") || !reading.has("scheme.cells")) return;
  const double least = (scene.scheme.degree + 1) * (scene.body.length / scene.scheme.cells);
  const auto check = [&](const std::string& key, const std::string& side, const std::optional<double>& said,
                         End end, double bound, bool far_enough) {
    if (!said) return;
    if (end == End::fixed)
      reading.report(
          reading.said.where(key),
          '`' + key + "` says how far the grid reaches beyond a free end; ends." + side + " is fixed");
    else if (!far_enough)
      reading.report(reading.said.where(key),
                     '`' + key + "` must be " + (side == "left" ? "at most " : "at least ") +
                         toml_number(bound) + " (m), degree + 1 cells beyond the body, not " +
                         toml_number(*said));
  };
  const double from = scene.body.left() - least;
  const double to = scene.body.right() + least;
  check("grid.from", "left", scene.grid.from, scene.ends.left, from, scene.grid.from <= from);
  check("grid.to", "right", scene.grid.to, scene.ends.right, to, scene.grid.to >= to);
  const double cells =
      (scene.grid.to.value_or(to) - scene.grid.from.value_or(from)) / least * (scene.scheme.degree + 1);
  if (cells > 1e8)
    reading.report(reading.said.where(scene.grid.to ? "grid.to" : "grid.from"),
                   "the grid must have at most 1e8 cells, not " + toml_number(cells));
}

void check_initial_velocity(Reading& reading) {
  const auto& initial = reading.scene.initial_velocity;
  if (!initial || !reading.has("initial.velocity.shape")) return;
  const bool linear = initial->shape == "linear";
  if (linear && reading.silent_on("initial.velocity.gradient") &&
      !reading.meant.contains("initial.velocity.gradient"))
    reading.report(
        reading.said.where("initial.velocity"),
        "`initial.velocity.gradient` is missing; the shape \"linear\" needs a finite number (1/s)");
  if (!linear && initial->gradient)
    reading.report(
        reading.said.where("initial.velocity.gradient"),
        "`initial.velocity.gradient` goes with the shape \"linear\", not \"" + initial->shape + '"');
}

/// One effect may hold an end, no more.
void check_held_ends(Reading& reading) {
  for (const std::string end : {"left", "right"}) {
    const EffectSpec* holder = nullptr;
    for (const EffectSpec& effect : reading.scene.effects) {
      if (!find_effect(reading.scene, effect).holds(effect, end, reading.body, reading.bodies)) continue;
      if (holder == nullptr)
        holder = &effect;
      else
        reading.report(effect.origin,
                       "the " + end + " end" +
                           (reading.bodies > 1 ? " of body " + std::to_string(reading.body) : "") +
                           " is held already, by the effect " + holder->type);
    }
  }
}

}  // namespace

void check_body(Reading& reading) {
  check_initial_velocity(reading);
  check_grid(reading);
  check_held_ends(reading);
}

}  // namespace hompm::detail
