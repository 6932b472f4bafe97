#include <chrono>
#include <cstdint>
#include <utility>

#include <hompm/kit/output/staging.hpp>
#include <hompm/kit/recorder/bytes.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/study/measure.hpp>
#include <hompm/plan/fields.hpp>
#include <hompm/simulation/run.hpp>
#include <hompm/simulation/simulation.hpp>

namespace hompm::study {
namespace {

std::int64_t bytes_of(const State& state) {
  std::size_t bytes = 0;
  visit_fields(state, [&](const FieldInfo&, auto values) { bytes += values.size_bytes(); });
  return static_cast<std::int64_t>(bytes);
}

Work work_of(const Scene& scene, const TimeStepping& stepping, const State& state) {
  const SchemeChoices& choices = scene.scheme.choices;
  const auto forces =
      stepping.steps * static_cast<std::int64_t>(splitting(choices.time_integrator).drifts.size());
  const int solves = (choices.acceleration_mass == MassForm::consistent ? 1 : 0) +
                     (choices.velocity_projection != VelocityProjection::lumped ? 1 : 0) +
                     (scene.scheme.relaxation_rate > 0.0 ? 1 : 0);
  return {.particles = std::int64_t{scene.scheme.cells} * scene.scheme.particles_per_cell,
          .steps = stepping.steps,
          .force_evaluations = forces,
          .mass_solves = forces * solves,
          .bytes = forces * bytes_of(state)};
}

/// The steps as planned, for a step that is too large, too.
TimeStepping planned(Scene scene) {
  scene.scheme.allow_unstable = true;
  return time_stepping(scene);
}

void fail(Record& record, Status status, const std::string& reason) {
  record.status = status;
  record.reason = reason;
}

/// From how many states of a run steps are counted, at least: from many of a small body, whose step is the
/// dearer the more cells its end has reached; from one of a very large body, where a state costs more than it
/// tells.
std::int64_t states_of(const Scene& scene) {
  const std::int64_t particles = std::int64_t{scene.scheme.cells} * scene.scheme.particles_per_cell;
  return particles > 20000 ? 1 : std::clamp<std::int64_t>(8192 / particles, 32, 256);
}

void run_and_judge(const Scene& scene, const Check& check, Measured& measured) {
  Record& record = measured.record;
  const TimeStepping stepping = time_stepping(scene);
  std::vector<State> moments;
  RunObserver observer;
  observer.progress = [&](std::int64_t, std::int64_t) { check(); };
  observer.checkpoint = [&](const RunPoint& point) { moments.push_back(point.states.front()); };
  observer.checkpoint_every = std::max<std::int64_t>(stepping.steps / (states_of(scene) + 1), 1);
  const RunResult result = run(scene, stepping, observer);
  // The first step finds the geometry ready and is cheaper: it counts only where there is no other.
  if (!moments.empty()) measured.moments = std::move(moments);
  std::string reason;
  record.errors = judge(scene, result, reason, [&](double) { check(); });
  if (!record.errors) fail(record, Status::unjudged, reason);
}

}  // namespace

Scene measured_scene(const Study& study, const Point& point) {
  Scene scene = scene_of(study, point);
  scene.output = {.snapshots = 1, .history = 1};
  return scene;
}

Measured measure(const Study& study, const Point& point, const std::string& program, const Check& check) {
  Measured measured;
  Record& record = measured.record;
  record.name = point.name;
  record.program = program;
  try {
    const Scene scene = measured_scene(study, point);
    record.scene = scene_text(scene);
    if (!scene.bodies.empty())
      throw SceneError(Origin{scene.case_name},
                       "a study needs an exact solution, and of several bodies none is known");
    record.scheme = scene.scheme.name;
    record.degree = scene.scheme.degree;
    record.cells = scene.scheme.cells;
    record.particles_per_cell = scene.scheme.particles_per_cell;
    measured.stepping = planned(scene);
    record.time_step = measured.stepping.time_step;
    const Simulation start(scene, measured.stepping.time_step);
    record.work = work_of(scene, measured.stepping, start.state());
    measured.moments.push_back(start.state());
    run_and_judge(scene, check, measured);
  } catch (const SceneError& error) {
    fail(record, Status::refused, error.what());
  } catch (const InvalidRun& error) {
    fail(record, Status::invalid, error.what());
  }
  return measured;
}

double timed(const Scene& scene) {
  using Clock = std::chrono::steady_clock;
  const TimeStepping stepping = time_stepping(scene);
  Clock::time_point start;
  bool started = false;
  run(scene, stepping,
      {.snapshot =
           [&](const Snapshot&) {
             if (!started) start = Clock::now();
             started = true;
           },
       .history = {},
       .progress = {}});
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void write_moments(const std::filesystem::path& folder, const Measured& measured) {
  detail::ByteWriter out;
  out.number(measured.stepping.time_step);
  out.word(measured.moments.size());
  for (const State& moment : measured.moments) detail::write_state(out, moment);
  detail::write_whole(folder / "moments", out.bytes);
  detail::write_whole(folder / "scene.toml", measured.record.scene);
}

std::int64_t step_from_moments(const std::filesystem::path& folder) {
  const Scene scene = load_scene(folder / "scene.toml", {});
  const auto path = folder / "moments";
  const std::string bytes = read_file(path);
  detail::ByteReader in(bytes);
  const auto readable = [&](const auto& read) {
    try {
      return read();
    } catch (const Error& error) {
      throw FileError("cannot read " + path.string() + ": " + error.what());
    }
  };
  Simulation simulation(scene, readable([&] { return in.number(); }));
  const std::size_t moments = readable([&] { return in.count(8); });
  for (std::size_t moment = 0; moment < moments; ++moment) {
    readable([&] { detail::read_state(in, simulation.state()); });
    simulation.step();
  }
  return static_cast<std::int64_t>(moments);
}

}  // namespace hompm::study
