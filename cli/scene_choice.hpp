// From the options of hompm-run to the scene they ask for.
#pragma once

#include <boost/program_options.hpp>

#include <hompm/recorder/checkpoint.hpp>
#include <hompm/scene/scene.hpp>

namespace hompm::cli {

/// The scene that is asked for: a case, a file, or that of a golden folder, with what the command line says
/// about it. Throws `UsageError`, and what `load_scene` throws.
Scene scene_of(const boost::program_options::variables_map& given);

/// Throws `UsageError` when the golden folder that --check names holds another scene. How often to write is
/// not part of what is simulated: it follows the golden scene unless the command line says otherwise.
void demand_same_scene(Scene& scene, const boost::program_options::variables_map& given);

/// The scene of the checkpoint, with a later end time where the command line asks for one. Throws
/// `UsageError` when the command line names another scene, and what `load_scene` throws.
Scene resumed_scene(const boost::program_options::variables_map& given, const Checkpoint& from);

}  // namespace hompm::cli
