// From the options of hompm-run to the scene they ask for.
#pragma once

#include <boost/program_options.hpp>

#include <hompm/scene/scene.hpp>

namespace hompm::cli {

/// The command line says something about the scene to run.
bool names_scene(const boost::program_options::variables_map& given);

/// The scene that is asked for: a case, a file, or that of a golden folder, with what the command line says
/// about it. Throws `UsageError`, and what `load_scene` throws.
Scene scene_of(const boost::program_options::variables_map& given);

/// Throws `UsageError` when the golden folder that --check names holds another scene. How often to write is
/// not part of what is simulated: it follows the golden scene unless the command line says otherwise.
void demand_same_scene(Scene& scene, const boost::program_options::variables_map& given);

/// Throws `UsageError` when `scene` is not that of the checkpoint, `resumed`.
void demand_resumed_scene(const Scene& scene, const Scene& resumed,
                          const boost::program_options::variables_map& given);

}  // namespace hompm::cli
