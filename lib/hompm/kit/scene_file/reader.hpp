// Scene files: reading, checking, built-in scenes, and writing the resolved scene back.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <hompm/effects/registry.hpp>

namespace hompm {

/// A key of the scene said on the command line. `value` is TOML text ("64", "1e-4", "\"rate\"") or a bare
/// word, which is taken as a string. `option` is what an error points at: "--cells 64" or "--set
/// scheme.cells=64".
struct Override {
  std::string key;
  std::string value;
  std::string option;
};

/// A scene shipped with the library.
struct BuiltinScene {
  std::string case_name;
  std::string variant;
  bool is_default;   ///< the variant taken when only the case is named
  std::string text;  ///< TOML
};

/// All built-in scenes, in the order in which `--list` shows them.
const std::vector<BuiltinScene>& builtin_scenes();

/// The built-in scene `case_name`, `variant` ("" for the default variant) with the overrides applied.
/// Throws `SceneError` for an unknown name (naming the nearest) or a bad override.
Scene load_builtin(const std::string& case_name, const std::string& variant,
                   const std::vector<Override>& overrides);

/// A scene file with the overrides applied. Throws `FileError` when it cannot be read, `SceneError` with
/// *all* problems of the file otherwise, each with file, line and column, the offending value and the nearest
/// valid one.
///
/// `effects` is what a scene may call for, the library's own or those and more; it must outlive the scene.
Scene load_scene(const std::string& path, const std::vector<Override>& overrides,
                 const EffectCatalogue& effects = effect_catalogue());

/// A scene from text; `source` names it in messages. Throws as `load_scene`.
Scene parse_scene(const std::string& text, const std::string& source, const std::vector<Override>& overrides,
                  const EffectCatalogue& effects = effect_catalogue());

/// The value of a key, in the units of a scene file (SI).
using SceneValue = std::variant<double, std::int64_t, bool, std::string>;

/// A scene made in code from keys and values: {"material.law", "linear"}, {"scheme.cells", 32},
/// {"effect[0].type", "gravity"}, {"body[1].length", 0.5}. Defaults and checks are those of a file; a message
/// has the key in the place of file and line. Throws as `parse_scene`.
Scene make_scene(const std::vector<std::pair<std::string, SceneValue>>& keys,
                 const EffectCatalogue& effects = effect_catalogue());

/// The resolved scene as TOML, every default written out; reading it gives the same scene, and writing that
/// the same bytes.
std::string scene_text(const Scene& scene);

/// One key a scene file may hold, as the reader knows it: for the reference documentation and `--keys`.
struct SceneKey {
  std::string path;                     ///< "scheme.cells"; of a parameter of an effect its name
  std::string type;                     ///< number, integer, word, text, boolean
  std::string unit;                     ///< SI; "" for none
  std::string range;                    ///< "> 0", "1 … 5"; "" where anything of the type goes
  std::vector<std::string> words = {};  ///< those allowed, of a word
  std::string condition = {};           ///< what other keys demand of it, in words
  bool required = false;                ///< must be given
  std::string optional_table = {};      ///< the table it belongs to, where that may be left out altogether
  std::string standard = {};  ///< default as TOML text, or in words where it follows from other keys
  std::string meaning = {};
};

/// All keys outside `[[effect]]` and `[[probe]]`.
const std::vector<SceneKey>& scene_keys();

/// The parameters of an effect.
std::vector<SceneKey> parameter_keys(const EffectType& effect);

/// The candidate nearest to `word` in edit distance, or "" when none is near enough to be what was meant.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace hompm
