// Scenes for tests: a built-in case with some keys changed.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>

#include <hompm/kit/scene_file/reader.hpp>

namespace hompm::test {

/// The case, its variant, and keys set as on the command line: built_in("bar", "large", {{"scheme.cells",
/// "16"}}).
inline hompm::Scene built_in(const std::string& case_name, const std::string& variant,
                             std::initializer_list<std::pair<std::string, std::string>> keys = {}) {
  std::vector<hompm::Override> overrides;
  for (const auto& [key, value] : keys) overrides.push_back({key, value, "--set " + key + "=" + value});
  return hompm::load_builtin(case_name, variant, overrides);
}

/// A body of 1 m, free at both ends, under nothing, at rest.
inline hompm::Scene free_body(std::initializer_list<std::pair<std::string, std::string>> keys = {}) {
  std::vector<hompm::Override> overrides;
  for (const auto& [key, value] : keys) overrides.push_back({key, value, "--set " + key + "=" + value});
  return hompm::parse_scene(R"(
end_time = 1.0
[body]
length = 1.0
[material]
law = "rate"
density = 1.0
youngs_modulus = 1.0
[ends]
left = "free"
right = "free"
[scheme]
cells = 16
particles_per_cell = 4
time_step = 1e-3
)",
                            "free body", overrides);
}

}  // namespace hompm::test
