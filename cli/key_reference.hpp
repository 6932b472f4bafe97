// Every key a scene may hold, as the reader knows it (hompm-run --keys).
#pragma once

#include <string>

namespace hompm::cli {

/// For people: keys and parameters of effects with unit, range, default and meaning.
std::string key_text();

/// The same as JSON: "keys" and "effects", with what is in a `SceneKey`.
std::string key_json();

}  // namespace hompm::cli
