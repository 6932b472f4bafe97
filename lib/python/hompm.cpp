// The Python module: runs, exact solutions, simulations step by step, comparison. Bits are those of
// hompm-run.
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <hompm/kit/kit.hpp>
#include <hompm/kit/scene_file/value_rule.hpp>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

namespace py = pybind11;

namespace hompm {
namespace {

using Keys = std::vector<std::pair<std::string, SceneValue>>;

SceneValue value_of(const py::handle& given, const std::string& key) {
  if (py::isinstance<py::bool_>(given)) return given.cast<bool>();
  if (py::isinstance<py::str>(given)) return given.cast<std::string>();
  if (PyIndex_Check(given.ptr()) != 0)
    return py::int_(py::reinterpret_borrow<py::object>(given)).cast<std::int64_t>();
  if (PyNumber_Check(given.ptr()) != 0)
    return py::float_(py::reinterpret_borrow<py::object>(given)).cast<double>();
  throw SceneError(Origin{key},
                   "must be a number, a text or a truth value, not " + py::repr(given).cast<std::string>());
}

/// Tables are dicts, [[lists]] are lists of dicts.
void flatten(const py::handle& given, const std::string& path, Keys& keys) {
  if (py::isinstance<py::dict>(given)) {
    for (const auto& [key, value] : py::reinterpret_borrow<py::dict>(given))
      flatten(value, (path.empty() ? "" : path + '.') + py::str(key).cast<std::string>(), keys);
  } else if (py::isinstance<py::list>(given) || py::isinstance<py::tuple>(given)) {
    std::size_t index = 0;
    for (const py::handle element : given) flatten(element, path + '[' + std::to_string(index++) + ']', keys);
  } else {
    keys.emplace_back(path, value_of(given, path));
  }
}

const std::map<std::string, std::string> shortcuts{{"scheme", "scheme.name"},
                                                   {"degree", "scheme.degree"},
                                                   {"cells", "scheme.cells"},
                                                   {"particles_per_cell", "scheme.particles_per_cell"},
                                                   {"time_step", "scheme.time_step"},
                                                   {"courant", "scheme.courant"},
                                                   {"step_fraction", "scheme.step_fraction"},
                                                   {"end_time", "end_time"},
                                                   {"snapshots", "output.snapshots"}};

/// A value as a scene file has it.
struct Text {
  std::string operator()(bool truth) const { return truth ? "true" : "false"; }
  std::string operator()(std::int64_t number) const { return std::to_string(number); }
  std::string operator()(double number) const { return detail::toml_number(number); }
  std::string operator()(const std::string& text) const { return detail::toml_string(text); }
};

/// The scene that the arguments of `run`, `exact` and `Simulation` name; `others` are `shortcuts` and keys of
/// a scene.
Scene scene_of(const std::string& case_name, const std::string& variant, const py::object& scene,
               const py::dict& set, const py::kwargs& others) {
  Keys changes;
  flatten(set, "", changes);
  for (const auto& [name, value] : others) {
    const auto word = py::str(name).cast<std::string>();
    const auto shortcut = shortcuts.find(word);
    changes.emplace_back(shortcut == shortcuts.end() ? word : shortcut->second, value_of(value, word));
  }
  if (case_name.empty() == scene.is_none())
    throw py::value_error("name a case (\"bar\", \"column\") or a scene (a dict, or the path of a file)");
  if (py::isinstance<py::dict>(scene)) {
    Keys keys;
    flatten(scene, "", keys);
    for (auto& change : changes) {
      std::erase_if(keys, [&](const auto& said) { return said.first == change.first; });
      keys.push_back(std::move(change));
    }
    return make_scene(keys);
  }
  std::vector<Override> overrides;
  for (const auto& [key, value] : changes) {
    const std::string said = std::visit(Text(), value);
    std::string option = key;
    overrides.push_back({key, said, option.append(" = ").append(said)});
  }
  if (scene.is_none()) return load_builtin(case_name, variant, overrides);
  return load_scene(py::str(scene).cast<std::string>(), overrides);
}

/// An array that owns the values.
py::array_t<double> array_of(std::vector<double> values, std::vector<py::ssize_t> shape) {
  auto held = std::make_unique<std::vector<double>>(std::move(values));
  double* const data = held->data();
  const py::capsule owner(held.release(), [](void* vector) {
    const std::unique_ptr<std::vector<double>> freed(static_cast<std::vector<double>*>(vector));
  });
  return py::array_t<double>(std::move(shape), data, owner);
}
py::array_t<double> array_of(std::vector<double> values) {
  const auto size = static_cast<py::ssize_t>(values.size());
  return array_of(std::move(values), {size});
}

py::object from_json(const std::string& text) { return py::module_::import("json").attr("loads")(text); }

/// Arrays by field, of one row for each snapshot.
py::dict fields_of(const std::vector<Snapshot>& snapshots) {
  py::dict fields;
  const auto add = [&](const std::string& name, const auto& values_of) {
    std::vector<double> all;
    for (const Snapshot& snapshot : snapshots) {
      const std::vector<double>& values = values_of(snapshot);
      all.insert(all.end(), values.begin(), values.end());
    }
    fields[py::str(name)] = array_of(std::move(all), {static_cast<py::ssize_t>(snapshots.size()),
                                                      static_cast<py::ssize_t>(snapshots.front().size())});
  };
  for (const auto& column : detail::all_columns)
    add(
        std::string(column.name), [&](const Snapshot& s) -> auto& { return s.*column.values; });
  for (std::size_t i = 0; i < snapshots.front().reported.size(); ++i)
    add(
        snapshots.front().reported[i].name, [&](const Snapshot& s) -> auto& { return s.reported[i].values; });
  return fields;
}

py::dict run_scene(const std::string& case_name, const std::string& variant, const py::object& given,
                   const py::dict& set, bool errors, const py::kwargs& others) {
  const Scene scene = scene_of(case_name, variant, given, set, others);
  std::vector<Snapshot> snapshots;
  std::vector<HistoryRow> rows;
  std::string report;
  {
    const py::gil_scoped_release free;
    const TimeStepping stepping = time_stepping(scene);
    RunObserver observer;
    RunMotion motion;
    observer.snapshot = [&](const Snapshot& snapshot) {
      snapshots.push_back(snapshot);
      motion.look(scene, snapshot);
    };
    observer.history = [&](const HistoryRow& row) { rows.push_back(row); };
    const auto interrupted = [] {
      const py::gil_scoped_acquire held;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    };
    constexpr std::int64_t now_and_then = 1024;  // steps
    observer.progress = [&](std::int64_t step, std::int64_t) {
      if (step % now_and_then == 0) interrupted();
    };
    const RunResult result = run(scene, stepping, observer);
    std::string reason = "errors=False was given";
    std::optional<ErrorReport> judged;
    const auto watch = [&](double) { interrupted(); };
    if (errors) judged = judge(scene, result, reason, watch, motion);
    if (std::string no_runs; errors && !judged) {
      judged = judge_by_runs(scene, result, reference_budget(scene, stepping, false), no_runs, watch, motion);
      reason += "; " + no_runs;
    }
    report = run_json(
        {scene, stepping, result, judged, reason, verdict_of(scene, result, judged, reason, motion)});
  }
  py::dict history;
  const auto add = [&](const std::string& name, double HistoryRow::*value) {
    std::vector<double> values;
    values.reserve(rows.size());
    for (const HistoryRow& row : rows) values.push_back(row.*value);
    history[py::str(name)] = array_of(std::move(values));
  };
  add("time", &HistoryRow::time);
  for (const auto& column : detail::history_columns) add(std::string(column.name), column.value);
  std::vector<double> times;
  times.reserve(snapshots.size());
  for (const Snapshot& snapshot : snapshots) times.push_back(snapshot.time);
  using namespace pybind11::literals;
  return py::dict("times"_a = array_of(std::move(times)), "fields"_a = fields_of(snapshots),
                  "history"_a = history, "report"_a = from_json(report), "scene"_a = scene_text(scene));
}

/// The exact or reference solution at X (m) and t (s), numbers or arrays that numpy broadcasts.
py::dict exact_at(const Scene& scene, const py::object& X, const py::object& t) {
  using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
  const py::tuple both =
      py::module_::import("numpy").attr("broadcast_arrays")(Array::ensure(X), Array::ensure(t));
  const auto places = both[0].cast<Array>();
  const auto times = both[1].cast<Array>();
  std::vector<MaterialPoint> points;
  for (py::ssize_t i = 0; i < places.size(); ++i) {
    points.push_back({times.data()[i], places.data()[i]});
    if (const std::string why = outside(scene, points.back()); !why.empty()) throw py::value_error(why);
  }
  ExactSolution exact;
  {
    const py::gil_scoped_release free;
    exact = exact_solution(scene, points);
  }
  const std::vector<py::ssize_t> shape(places.shape(), places.shape() + places.ndim());
  const auto fields = [&](auto& from) {
    py::dict all;
    for (const auto& [name, values] : {std::pair{"displacement", &from.displacement},
                                       {"velocity", &from.velocity},
                                       {"stress", &from.stress},
                                       {"stretch", &from.stretch}})
      if (!values->empty() || points.empty()) all[name] = array_of(std::move(*values), shape);
    return all;
  };
  py::dict result = fields(exact.fields);
  result["reference"] = exact.reference;
  if (!exact.body_force.empty()) result["body_force"] = array_of(std::move(exact.body_force), shape);
  result["error"] = fields(exact.fields.error);
  return result;
}

/// A simulation and its first time step.
struct Stepper {
  explicit Stepper(const Scene& scene) : Stepper(scene, time_stepping(scene)) {}
  Stepper(const Scene& scene, const TimeStepping& stepping)
      : time_step(stepping.time_step),
        end_time(scene.end_time),
        steps(stepping.steps),
        simulation(scene, time_step) {}
  double time_step, end_time;
  std::int64_t steps;
  Simulation simulation;

  void step(std::int64_t count, std::optional<double> length) {
    for (std::int64_t i = 0; i < count; ++i) simulation.step(length.value_or(time_step));
  }
};

/// The entries of a field of the particles, without markers, where they are: no copy.
py::array_t<double> view(const py::object& self, const std::string& name, std::size_t body) {
  auto& stepper = self.cast<Stepper&>();
  if (body >= stepper.simulation.bodies()) throw py::index_error("there is no body " + std::to_string(body));
  State& state = stepper.simulation.state(body);
  std::vector<double>* values = state.find("particles." + name);
  std::vector<std::string> names;
  for (const CoreField& field : core_fields) {
    if (field.info.site != Site::particle) continue;
    names.emplace_back(field.info.name.substr(std::string("particles.").size()));
    if (names.back() == name) values = std::get<std::vector<double>*>(field.of(state));
  }
  if (values == nullptr) {
    const std::string near = nearest(name, names);
    throw py::key_error("particles have no field " + name +
                        (near.empty() ? "" : "; did you mean " + near + "?"));
  }
  const std::size_t markers = state.particles.markers;
  return py::array_t<double>(static_cast<py::ssize_t>(values->size() - 2 * markers), values->data() + markers,
                             self);
}

}  // namespace
}  // namespace hompm

PYBIND11_MODULE(hompm, module) {
  using namespace hompm;
  using namespace pybind11::literals;
  module.doc() =
      "Material point methods in one dimension: runs, exact solutions, simulations step by step. SI units.";
  module.attr("__version__") = build_info().version;
  const auto error = py::register_exception<Error>(module, "Error");
  py::register_exception<SceneError>(module, "SceneError", error);
  py::register_exception<InvalidRun>(module, "InvalidRun", error);
  py::register_exception<FileError>(module, "FileError", error);
  py::register_exception<ArithmeticError>(module, "ArithmeticError", error);

  module.def("run", &run_scene, "case"_a = "", "variant"_a = "", "scene"_a = py::none(), "set"_a = py::dict(),
             "errors"_a = true,
             R"(Runs a scene.

case, variant: a built-in one; or scene: a dict, or the path of a file. set: further keys, {"scheme.cells": 64}.
Keywords: scheme, degree, cells, particles_per_cell, time_step, courant, step_fraction, end_time, snapshots.
Returns a dict: times (s); fields, by name an array of times × particles (X, x, displacement, velocity, ...);
history, by column an array; report, which is run.json; scene, the scene as run.)");
  py::class_<Scene>(module, "exact", "The exact or reference solution of a scene, named as for run.")
      .def(py::init(&scene_of), "case"_a = "", "variant"_a = "", "scene"_a = py::none(), "set"_a = py::dict())
      .def("__call__", &exact_at, "X"_a, "t"_a,
           R"(At X (m) and t (s), numbers or arrays that broadcast, in any order.

Returns a dict: displacement (m), velocity (m/s), stress (Pa), stretch, arrays of the shape of X and t; reference, which solution it is;
error, its own at these points by field, empty for a closed form; of a manufactured solution body_force (m/s²).)");
  py::class_<Stepper>(module, "Simulation", "A scene, named as for run, step by step.")
      .def(py::init([](const std::string& c, const std::string& v, const py::object& s, const py::dict& set,
                       const py::kwargs& others) { return Stepper(scene_of(c, v, s, set, others)); }),
           "case"_a = "", "variant"_a = "", "scene"_a = py::none(), "set"_a = py::dict())
      .def("step", &Stepper::step, "count"_a = 1, "length"_a = py::none(),
           py::call_guard<py::gil_scoped_release>(), "Takes steps of the length (s; default time_step).")
      .def("field", &view, "name"_a, "body"_a = 0,
           "A field of the particles as it is now, in place: what is written there goes into the next step.")
      .def(
          "snapshot",
          [](const Stepper& s) { return fields_of({s.simulation.snapshot(s.simulation.state().time)}); },
          "All fields with velocities at the time of the positions, arrays of 1 × particles.")
      .def(
          "copy", [](const Stepper& s) { return Stepper(s); }, "A copy that goes on by itself.")
      .def("__eq__", [](const Stepper& a, const Stepper& b) { return a.simulation == b.simulation; })
      .def_property_readonly(
          "time", [](const Stepper& s) { return s.simulation.state().time; }, "s")
      .def_readonly("time_step", &Stepper::time_step, "s")
      .def_readonly("end_time", &Stepper::end_time, "s")
      .def_readonly("steps", &Stepper::steps, "to the end time");
  module.def(
      "compare",
      [](const std::string& a, const std::string& b) {
        const Comparison found = compare_folders(a, b, {});
        py::list fields;
        for (const FieldComparison& field : found.fields)
          fields.append(py::dict("file"_a = field.file, "field"_a = field.field, "values"_a = field.values,
                                 "differing"_a = field.differing,
                                 "largest_absolute"_a = field.largest_absolute));
        return py::dict("verdict"_a = to_string(found.verdict), "messages"_a = found.messages,
                        "fields"_a = fields);
      },
      "a"_a, "b"_a, "Compares the result folders a and b exactly, as hompm-diff does.");
}
