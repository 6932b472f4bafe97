// A small run to write, damage and compare. Its numbers mean nothing, but none of them is round or repeats.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include <hompm/kit/output/run_folder.hpp>
#include <hompm/simulation/records.hpp>

namespace hompm::test {

/// Fields of `particles` particles at `time`; values differ from field to field, particle to particle and
/// time to time.
inline Snapshot sample_snapshot(double time, std::size_t particles) {
  Snapshot snapshot;
  snapshot.time = time;
  double seed = 0.1 + time;
  for (auto* values :
       {&snapshot.reference_position, &snapshot.position, &snapshot.displacement, &snapshot.velocity,
        &snapshot.volume, &snapshot.density, &snapshot.stress, &snapshot.stretch}) {
    seed = 3.0 * seed + 1.0 / 7.0;
    for (std::size_t i = 0; i < particles; ++i) values->push_back(seed + static_cast<double>(i) / 3.0);
  }
  return snapshot;
}

/// Balances at `time`.
inline HistoryRow sample_history(double time) {
  return {time,         time / 3.0,  time / 7.0,  -time / 9.0,  time / 11.0, time / 13.0,
          time * 1e-16, time / 17.0, time / 19.0, time * 1e-15, 25.0,        1e-17};
}

/// Writes and publishes a run of `particles` particles at three times, with scene.toml and run.json.
inline void write_sample_run(const std::filesystem::path& folder, std::size_t particles, bool vtk = false) {
  RunFolder run(folder, vtk);
  for (const double time : {0.0, 0.1, 0.25}) {
    run.write(sample_snapshot(time, particles));
    run.write(sample_history(time));
  }
  run.write("scene.toml", "case = \"bar\"\ncells = 64\n");
  run.write("run.json", "{}\n");
  run.publish();
}

}  // namespace hompm::test
