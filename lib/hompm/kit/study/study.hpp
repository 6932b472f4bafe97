// A study: one scene, many settings of it. What is to be run, as plain data.
#pragma once

#include <string>
#include <vector>

#include <hompm/scene/scene.hpp>

namespace hompm::study {

/// A key of the scene with one value, as text: `scheme.cells`, `64`.
struct Setting {
  std::string key;
  std::string value;
  std::string where = {};  ///< it was said, for messages; "" for nowhere in particular
  bool operator==(const Setting& other) const { return key == other.key && value == other.value; }
};

/// A key that is varied. The value `all` stands for what the table of schemes has: of `scheme.name` every
/// row, of `scheme.degree` every degree of the row, of `scheme.time_integrator` the row's own and, where that
/// is of second order, blanes-moan. Of `scheme.name`, `first-order` stands for the rows of first order in
/// time, `higher-order` for the others.
struct Axis {
  std::string key;
  std::vector<std::string> values;
  std::string where = {};  ///< they were said, for messages
};

/// Every combination of the values of its axes.
using Sweep = std::vector<Axis>;

struct Study {
  std::string case_name = {};          ///< built in; "" where `scene_file` is set
  std::string variant = {};            ///< "" for the default one
  std::string scene_file = {};         ///< path
  std::vector<Setting> settings = {};  ///< the same in every point
  std::vector<Sweep> sweeps = {};
};

/// One run of a study.
struct Point {
  std::string name;  ///< of its settings alone: "scheme=bspline,degree=2,cells=16"; also a file name
  std::vector<Setting> settings;
};

/// The axes in the order scheme, degree, time integrator, cells, particles, time step, others by name.
Sweep in_order(Sweep sweep);

/// The points of all sweeps, in order, each once. Their settings are `in_order`: the order of
/// the axes does not matter. Throws `SceneError` for more than 10000.
std::vector<Point> points_of(const Study& study);

/// The scene of a point. Throws `SceneError`.
Scene scene_of(const Study& study, const Point& point);

/// The points of the study, checked: throws `SceneError` when a value makes no sense in any of its points (a
/// value that only some schemes refuse is theirs to fail with), or when the scene itself is wrong.
std::vector<Point> checked_points(const Study& study);

/// All schemes on the scene: those of first order in time with their own degree, the others with every degree
/// and time integrator, for grids and time steps that make sense for either.
std::vector<Sweep> usual_sweeps();

/// The axis `text` of `--vary`: "cells=8,16", or "cells" for values that make sense. Throws `SceneError`.
std::vector<Axis> read_axes(const std::string& text);

/// The key of a scene that `said` means: itself, or `scheme.` left out, `-` for `_`, "scheme" for its name.
/// Throws `SceneError` at `where`, naming the nearest key.
std::string full_key(const std::string& said, const std::string& where);
/// The key without `scheme.`: "degree"; "scheme" for the scheme's name.
std::string short_key(const std::string& key);
/// A number as its shortest text, "16", "0.1"; a word as it is. Throws `SceneError` at `where` for a text
/// that has no place in the name of a point.
std::string canonical_value(const std::string& said, const std::string& where);

/// A study file (TOML): `case` and `variant`, or `scene`; a table `set`; tables `[[sweep]]`, each with a
/// value or a list of values per key. Throws `FileError`, and `SceneError` with all problems.
Study read_study(const std::string& path);
/// The study as such a file.
std::string study_text(const Study& study);

}  // namespace hompm::study
