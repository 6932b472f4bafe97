// A run with all it reports, for comparing runs bit for bit, and scenes in which everything happens.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <hompm/kit/recorder/checkpoint.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/simulation/records.hpp>
#include <hompm/simulation/run.hpp>

namespace hompm::test {

/// With memory where that is possible.
inline std::string law_of(const std::string& kinematics, const std::string& integrator) {
  if (kinematics == "finite") return "hencky\"";
  if (integrator == "blanes-moan") return "linear\"";
  return "elastoplastic\", yield_stress = 100, tangent_modulus = 2e3";
}

/// A soft column under all effects, both kinematics and every integrator possible; 60 steps.
inline Scene busy_scene(const std::string& scheme, int degree, const std::string& integrator,
                        const std::string& kinematics) {
  return parse_scene(R"(
end_time = 0.06
kinematics = ")" + kinematics +
                         R"("
body.length = 2.4
material = { law = ")" + law_of(kinematics, integrator) +
                         R"(, density = 1000, youngs_modulus = 1e4 }
initial.velocity = { shape = "sine", amplitude = 0.3, mode = 1 }
ends.right = "free"
effect = [ { type = "gravity", acceleration = -9.81 }, { type = "traction", value = 100 },
           { type = "mass-damping", rate = 2 }, { type = "local-damping", coefficient = 0.1 })" +
                         (integrator == "blanes-moan" ? "" : R"(, { type = "viscosity", viscosity = 1 },
           { type = "bulk-viscosity" })") +
                         R"( ]
output = { snapshots = 4, history = 9 }
[scheme]
cells = 8
particles_per_cell = 4
time_step = 1e-3
name = ")" + scheme + R"("
time_integrator = ")" + integrator +
                         R"("
degree = )" + std::to_string(degree),
                     "busy scene", {});
}

/// Two bars in contact from the start that part again, of two materials, grids and loads; 30 steps.
inline Scene colliding_bars(const std::string& integrator, const std::string& scheme = "high-order") {
  return parse_scene(R"(
end_time = 0.03
ends = { left = "free", right = "free" }
effect = [ { type = "contact" }, { type = "gravity", acceleration = -9.81, body = 1 },
           { type = "viscosity", viscosity = 1, body = 0 } ]
output = { snapshots = 3, history = 7 }
[scheme]
name = ")" + scheme + R"("
cells = 8
particles_per_cell = 4
time_step = 1e-3
time_integrator = ")" + integrator +
                         R"("
[[body]]
length = 1
material = { law = "neo-hookean", density = 1000, youngs_modulus = 1e4 }
initial.velocity = { shape = "uniform", amplitude = 0.3 }
[[body]]
start = 1
length = 1
cells = 10
material = { law = "hencky", density = 500, youngs_modulus = 1e4 }
)",
                     "colliding bars", {});
}

struct RecordedRun {
  Checkpoint reported;             ///< its history and snapshots
  std::vector<Checkpoint> points;  ///< with what was reported up to there
  RunResult result;
};

/// Runs `scene`, or what is left of it after the checkpoint `from`.
inline RecordedRun record_run(const Scene& scene, std::int64_t every, const Checkpoint* from = nullptr) {
  RecordedRun run{from != nullptr ? *from : first_checkpoint(scene), {}, {}};
  Checkpoint& reported = run.reported;
  RunObserver observer;
  observer.snapshot = [&](const Snapshot& snapshot) { reported.snapshots.push_back(snapshot); };
  observer.history = [&](const HistoryRow& row) { reported.history.push_back(row); };
  observer.checkpoint_every = every;
  observer.checkpoint = [&](const RunPoint& point) {
    run.points.push_back(reported);
    run.points.back().point = point;
  };
  run.result = hompm::run(scene, time_stepping(scene), observer, from != nullptr ? &from->point : nullptr);
  return run;
}

/// All numbers of a run in a row.
inline std::vector<double> numbers_of(const RecordedRun& run) {
  std::vector<double> all;
  const auto add = [&](const HistoryRow& row) {
    all.push_back(row.time);
    for (const auto& column : hompm::detail::history_columns) all.push_back(row.*column.value);
  };
  for (const auto& row : run.reported.history) add(row);
  for (const auto& snapshot : run.reported.snapshots) {
    all.push_back(snapshot.time);
    for (const auto& column : hompm::detail::all_columns)
      all.insert(all.end(), (snapshot.*column.values).begin(), (snapshot.*column.values).end());
  }
  const RunResult& r = run.result;
  add(r.start);
  add(r.end);
  for (const double value :
       {r.largest_residual, r.largest_momentum_residual, r.largest_internal_force_sum, r.largest_energy,
        r.largest_momentum, r.largest_step_fraction, r.largest_wave_speed, static_cast<double>(r.steps),
        static_cast<double>(r.at_rest)})
    all.push_back(value);
  return all;
}

}  // namespace hompm::test
