// What the keys of a body demand of each other.
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <hompm/kit/scene_file/reading.hpp>

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

/// Positions must tell neighbouring particles apart, to six digits of their distance.
void check_digits(Reading& reading) {
  const Scene& scene = reading.scene;
  for (const std::string key : {"body.length", "scheme.cells", "scheme.particles_per_cell"})
    if (!reading.has(key)) return;
  const double length = scene.body.length;
  const double width = length / scene.scheme.cells;
  const double distance = width / scene.scheme.particles_per_cell;
  const double beyond = scene.scheme.margin_cells * width;
  double reach = 0.0;
  std::string farthest;
  const auto look = [&](const std::string& key, double place) {
    if (!(std::abs(place) > reach)) return;
    reach = std::abs(place);
    farthest = key;
  };
  look("scheme.cells", length);
  look("body.start", scene.body.left());
  look("body.start", scene.body.right());
  if (scene.ends.left == End::free) look("scheme.margin_cells", scene.body.left() - beyond);
  if (scene.ends.right == End::free) look("scheme.margin_cells", scene.body.right() + beyond);
  look("grid.from", scene.grid.from.value_or(0.0));
  look("grid.to", scene.grid.to.value_or(0.0));
  if (const auto& field = scene.initial_displacement)
    for (const double place : {0.0, 0.5, 1.0})
      look("initial.displacement.amplitude", scene.body.left() + place * length + field->at(place, length));
  constexpr double digit = 1e6 * std::numeric_limits<double>::epsilon();
  if (distance >= digit * reach) return;
  reading.report(reading.said.where(reading.has(farthest) ? farthest : "body"),
                 "particles " + toml_number(distance) + " m apart and " + toml_number(reach) +
                     " m from the origin are not told apart well enough by positions of 16 digits: that far "
                     "apart they must stay within " +
                     toml_number(distance / digit) + " m; move the origin, or take fewer particles");
}

/// The gradient goes with the shape linear. Whether the field can be used.
bool check_gradient(Reading& reading, const std::string& table, const std::optional<InitialField>& field,
                    const std::string& unit) {
  if (!field || !reading.has(table + ".shape")) return false;
  const std::string key = table + ".gradient";
  const bool linear = field->shape == "linear";
  if (linear && reading.silent_on(key) && !reading.meant.contains(key))
    reading.report(reading.said.where(table),
                   '`' + key + "` is missing; the shape \"linear\" needs a finite number" + unit);
  if (!linear && field->gradient)
    reading.report(reading.said.where(key),
                   '`' + key + "` goes with the shape \"linear\", not \"" + field->shape + '"');
  return linear == field->gradient.has_value();
}

/// The body stays on its fixed ends, on the grid, and right side out.
void check_displacement(Reading& reading) {
  const Scene& scene = reading.scene;
  const std::string table = "initial.displacement";
  if (!check_gradient(reading, table, scene.initial_displacement, "")) return;
  for (const std::string key : {"initial.displacement.amplitude", "body.length", "scheme.cells"})
    if (!reading.has(key)) return;
  const InitialField& field = *scene.initial_displacement;
  const double length = scene.body.length;
  const Origin& at = reading.said.where(table);
  const bool moves = scene.kinematics == Kinematics::finite;
  if (moves && !(field.steepest(length) < 1.0 || (field.shape == "linear" && field.gradient > 0.0)))
    reading.report(at,
                   "`initial.displacement` turns the body inside out: its gradient must be above -1, not " +
                       toml_number(-field.steepest(length)));
  const auto check_end = [&](const std::string& end, End kind, double place, double room) {
    const double moved = field.at(place, length);
    if (kind == End::fixed && std::abs(moved) > 1e-12 * length)
      reading.report(at, "`initial.displacement` moves the " + end + " end by " + toml_number(moved) +
                             " m, which is fixed");
    const double outward = place > 0.0 ? moved : -moved;
    if (kind == End::free && moves && outward > room)
      reading.report(at, "`initial.displacement` moves the " + end + " end by " + toml_number(moved) +
                             " m, off the grid, which reaches " + toml_number(room) +
                             " m beyond it: raise `scheme.margin_cells`");
  };
  const double margin = scene.scheme.margin_cells * (length / scene.scheme.cells);
  const auto& [from, to] = scene.grid;
  check_end("left", scene.ends.left, 0.0, from ? scene.body.left() - *from : margin);
  check_end("right", scene.ends.right, 1.0, to ? *to - scene.body.right() : margin);
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
  check_gradient(reading, "initial.velocity", reading.scene.initial_velocity, " (1/s)");
  check_displacement(reading);
  check_grid(reading);
  check_digits(reading);
  check_held_ends(reading);
}

}  // namespace hompm::detail
