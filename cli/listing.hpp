// What hompm-run can print without running, as text of at most 80 columns or as one JSON object.
#pragma once

#include <string>

#include <hompm/simulation/time_step.hpp>

namespace hompm::cli {

enum class Form { text, json };

/// --list: cases with their variants, schemes, materials, effects; as JSON the formats of files, too.
std::string catalogue(Form form);

/// --keys: every key a scene may hold and every parameter of an effect, as the reader knows them: unit,
/// range, default, meaning. As JSON "keys" and "effects", with what is in a `SceneKey`.
std::string key_reference(Form form);

/// --explain: the stages of a step in order, what called for each and what it owns, the arrays of the state,
/// and the effects that are absent.
std::string explanation(const Scene& scene, const TimeStepping& stepping, Form form);

/// --critical-step: the critical step of each body at the start and, where free ends move, on their way
/// through a cell.
std::string critical_steps(const Scene& scene, Form form);

}  // namespace hompm::cli
