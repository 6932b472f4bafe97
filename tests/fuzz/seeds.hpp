// What binary files the fuzzers start from: HOMPM_SEEDS names a folder; they are written there, and the
// program ends.
#pragma once

#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <hompm/kit/scene_file/reader.hpp>

/// Small scenes of several kinds, of some ten steps.
inline std::vector<hompm::Scene> seed_scenes() {
  std::vector<hompm::Scene> scenes;
  for (const char* scheme : {"classical", "cpdi", "apic", "total-lagrangian", "tls", "high-order"})
    scenes.push_back(hompm::load_builtin("bar", "large",
                                         {{"scheme.name", scheme, "seed"},
                                          {"scheme.cells", "3", "seed"},
                                          {"scheme.time_step", "0.001", "seed"},
                                          {"end_time", "0.012", "seed"}}));
  return scenes;
}

/// Writes `seed_of` each of them, when seeds are wanted.
inline void write_seeds(const std::function<std::string(const hompm::Scene&)>& seed_of) {
  const char* const folder = std::getenv("HOMPM_SEEDS");
  if (folder == nullptr) return;
  for (const hompm::Scene& scene : seed_scenes())
    std::ofstream(std::string(folder) + "/" + scene.scheme.name, std::ios::binary) << seed_of(scene);
  std::exit(0);
}
