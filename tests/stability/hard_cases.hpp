// What the tests of hard cases have in common: the shipped scenes, and numbers that docs/stability.md shows.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <hompm/number.hpp>
#include <hompm/simulation/run.hpp>

#include "support/scenes.hpp"

namespace hompm::test {

inline const std::vector<std::string> all_schemes{"classical", "bspline", "tielen2017", "high-order"};

inline bool reconstructs(const std::string& scheme) {
  return scheme == "tielen2017" || scheme == "high-order";
}

/// The scene docs/scenes/hard/NAME.toml, with keys set as on the command line.
inline Scene hard(const std::string& name,
                  std::initializer_list<std::pair<std::string, std::string>> keys = {}) {
  std::vector<Override> overrides;
  for (const auto& [key, value] : keys) overrides.push_back({key, value, "--set " + key + "=" + value});
  return load_scene(std::string(HOMPM_SOURCE_DIR) + "/docs/scenes/hard/" + name + ".toml", overrides);
}

/// A number that was measured and checked, for the table and the picture of docs/stability.md: a line of the
/// file that HOMPM_MEASURED names, if it does.
inline void shown(const std::string& hard_case, const std::string& series, double x, double value) {
  const char* path = std::getenv("HOMPM_MEASURED");
  if (path == nullptr) return;
  std::ofstream(path, std::ios::app) << hard_case << ',' << series << ',' << to_text(x) << ','
                                     << to_text(value) << '\n';
}

/// The larger of the two, and infinity where `value` is not a number: a bound must not overlook it.
inline double larger(double most, double value) {
  return std::isnan(value) ? std::numeric_limits<double>::infinity() : std::max(most, value);
}

/// The largest |value(particles, i)|.
template <class Value>
double largest(const Simulation& simulation, Value value) {
  const Particles& p = simulation.state().particles;
  double most = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) most = larger(most, std::abs(value(p, i)));
  return most;
}

}  // namespace hompm::test
