// What is simulated, and how: the plain data of a scene after reading, with every default filled in.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/scene/scheme_choices.hpp>

namespace hompm {

struct Body {
  double length = 0.0;          ///< m
  std::optional<double> start;  ///< m, of the left end at t = 0; 0 where it is not said

  [[nodiscard]] double left() const { return start.value_or(0.0); }
  [[nodiscard]] double right() const { return left() + length; }
};

struct MaterialSpec {
  std::string law;              ///< a row of `material_laws` (materials/material.hpp)
  double density = 0.0;         ///< kg/m³, of the undeformed material
  double youngs_modulus = 0.0;  ///< Pa
  /// What else the law asks for; without a value what another law would.
  std::map<std::string, std::optional<double>> parameters = {};

  [[nodiscard]] double number(const std::string& key) const { return parameters.at(key).value(); }
};

/// Velocity (m/s) or displacement (m) at t = 0, with X from the left end of the body: sine, amplitude ·
/// sin(mode π X / length); uniform, amplitude; linear, amplitude + gradient · X.
struct InitialField {
  std::string shape;                    ///< sine, uniform, linear
  double amplitude = 0.0;               ///< m/s or m
  int mode = 1;                         ///< half waves over the body
  std::optional<double> gradient = {};  ///< 1/s or –, of the shape linear

  /// At the part `place` of a body of the length (m), from 0 at its left end to 1.
  [[nodiscard]] double at(double place, double length) const;
  /// ∂/∂X of that, 1/s or –.
  [[nodiscard]] double slope_at(double place, double length) const;
  /// ∫ at dX from the left end to there, m²/s or m².
  [[nodiscard]] double integral_to(double place, double length) const;
  /// The largest size of the slope.
  [[nodiscard]] double steepest(double length) const;
};

enum class End { fixed, free };
enum class Kinematics { infinitesimal, finite };

struct Ends {
  End left = End::fixed;
  End right = End::fixed;
};

struct EffectType;

/// What a user should know of a scene or a run that goes on all the same.
struct Warning {
  std::string code;  ///< stays the same from version to version: "large-strain"
  std::string text;  ///< what is wrong, and what to take instead
};

/// One `[[effect]]` table. Which parameters it has is the business of the effect (effects/registry.hpp).
struct EffectSpec {
  using Value = std::variant<double, std::int64_t, std::string>;
  std::string type;
  std::map<std::string, Value> parameters;
  Origin origin;
  /// The body it acts on, of a coupling the left one; on every one where it is not said.
  std::optional<std::int64_t> body = {};

  /// The parameter `key`. Both throw `SceneError` where the effect has no such number or word.
  [[nodiscard]] double number(const std::string& key) const;
  [[nodiscard]] const std::string& text(const std::string& key) const;
};

/// Exactly one of `time_step`, `courant`, `step_fraction` is set.
struct SchemeSpec {
  std::string name;
  int degree = 0;
  int cells = 0;  ///< over the body's length
  int particles_per_cell = 0;
  int margin_cells = 0;                 ///< grid cells beyond each free end
  std::optional<double> time_step;      ///< s
  std::optional<double> courant;        ///< c Δt / h
  std::optional<double> step_fraction;  ///< Δt over the critical step of the scheme
  SchemeChoices choices;                ///< those of the row `name`, but for what the scene says itself
  double relaxation_rate = 0.0;         ///< 1/s, of the null space
  bool allow_unstable = false;          ///< run with a step above the critical one all the same
};

/// How far the grid reaches at least; `margin_cells` beyond a free end where it is not said.
struct GridSpec {
  std::optional<double> from;  ///< m
  std::optional<double> to;    ///< m
};

/// The run ends as soon as the body is at rest: when no particle has moved faster than `speed` for the time a
/// wave takes to travel the body and back, while no load changed and no gap was about to close.
struct Rest {
  double speed = 0.0;              ///< m/s
  std::optional<double> earliest;  ///< s, before which the run does not end
};

struct OutputSpec {
  int snapshots = 10;  ///< after the start, evenly spaced in time
  int history = 100;   ///< rows of history.csv after the start
};

/// One `[[probe]]` table: a point whose fields are written over time. Exactly one of X, x, end is said.
struct ProbeSpec {
  std::optional<double> X;                ///< m, a material point
  std::optional<double> x;                ///< m, a place in space
  std::string end;                        ///< left, right: an end of the body; "" with X or x
  std::optional<std::int64_t> body = {};  ///< which, where X or end do not tell
  std::optional<std::int64_t> rows = {};  ///< after the start, evenly spaced in time; else as the history
};

/// The largest bound of the relative error of each field at the end that the run may have, to be of use.
struct Requirement {
  std::optional<double> displacement, velocity, stress;
};

struct Scene {
  std::string case_name;  ///< "bar", "column", or the name of a scene of one's own
  std::string variant;    ///< "" where there is none
  std::string title;
  double end_time = 0.0;  ///< s
  Kinematics kinematics = Kinematics::finite;
  Body body;
  MaterialSpec material;
  std::optional<InitialField> initial_velocity;
  std::optional<InitialField> initial_displacement;  ///< what it does to the stretch makes the stress
  Ends ends;
  GridSpec grid;
  std::vector<EffectSpec> effects;
  std::optional<Rest> rest;
  SchemeSpec scheme;
  OutputSpec output;
  std::vector<ProbeSpec> probes;
  Requirement require;

  /// The scene of each body, where there are several: what they share is the same in all, each has the
  /// effects that act on it. Body, material, ends and the like of this scene are then those of the
  /// first.
  std::vector<Scene> bodies;

  /// x = X + u at t = 0 of a point of the body (m).
  [[nodiscard]] double displaced(double X) const;

  /// What the types of effects mean; null: what the library brings. Must outlive the scene.
  const std::vector<EffectType>* effect_types = nullptr;

  /// Where each key was said ("scheme.cells", "effect[0].acceleration"); a key left to its default is absent.
  std::map<std::string, Origin> origins;

  /// Where the key was said; of one left to its default its name.
  [[nodiscard]] Origin origin_of(const std::string& key) const {
    const auto said = origins.find(key);
    return said == origins.end() ? Origin{key} : said->second;
  }

  /// What reading it had to tell.
  std::vector<Warning> warnings;
};

/// The scenes of all bodies: `bodies`, or the scene itself.
std::vector<const Scene*> bodies_of(const Scene& scene);

}  // namespace hompm
