// The stations a scene passes on its way from TOML to a Scene. Each reports what it finds wrong and goes on.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/scene_file/toml_values.hpp>

namespace hompm::detail {

struct Reading {
  Said said;
  Scene scene = {};
  std::vector<Problem> problems = {};
  std::int64_t body = 0;  ///< which body is read, of the `bodies` there are
  std::int64_t bodies = 1;
  std::set<std::string> meant = {};  ///< keys that a misspelt one stands for: not reported as missing too

  void report(const Origin& origin, std::string message);
  /// Whether the key was said and accepted.
  [[nodiscard]] bool has(const std::string& path) const { return scene.origins.contains(path); }
  /// Whether the scene leaves the key to its default.
  [[nodiscard]] bool silent_on(const std::string& path) const { return said.find(path) == nullptr; }
  /// The value at `path` where the rule accepts it, which also notes its origin; otherwise reports, calling
  /// the key `label`. The key must have been said.
  std::optional<Content> take(const std::string& path, const std::string& label, const ValueRule& rule);
};

/// Puts the overrides in the place of what the file says.
void apply_overrides(Reading& reading, const std::vector<Override>& overrides);

/// How many [[body]] tables there are; 0 where the scene has none, or wrong ones, which are reported.
std::size_t count_bodies(Reading& reading);

/// What a scene with [[body]] tables says of one of them, as if it were the only one: what its table says
/// goes before what the scene says of all.
Said said_of_body(const Said& all, std::size_t body);

/// The name in a [[body]] table of the key at `path`: "cells" for "scheme.cells"; "" where all bodies share
/// it.
std::string name_in_body(const std::string& path);

/// Whether the effect acts on the body that is read.
bool concerns(const Reading& reading, const EffectSpec& effect);

/// Reports keys and tables that no scene has, outside `[[effect]]`.
void check_names(Reading& reading);

/// Reports the names in the table at `path` of a list that are none of `names`, of `what`: "the effect
/// gravity". Returns those that were meant, "" for each where none is near.
std::set<std::string> check_names_in(Reading& reading, const std::string& path,
                                     const std::vector<std::string>& names, const std::string& what);

/// Fills the scene from the table of keys.
void read_keys(Reading& reading);

/// Fills `scene.effects` from the effect catalogue.
void read_effects(Reading& reading);

/// Fills `scene.probes`, once all bodies are read.
void read_probes(Reading& reading);

/// A probe as TOML.
std::string probe_text(const ProbeSpec& probe);

/// Reports effects that do not go with the rest of the scene, once that is complete.
void check_effects(Reading& reading);

/// Checks the keys of the body against each other: velocity at the start, grid, what holds its ends.
void check_body(Reading& reading);

/// Derives the defaults that follow from other keys, and checks the keys against each other.
void complete(Reading& reading);

}  // namespace hompm::detail
