// From the options of hompm-run to the scene they ask for, and what is done with it.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <hompm/kit/recorder/checkpoint.hpp>
#include <hompm/reference/reference.hpp>

#include "common.hpp"

namespace hompm::cli {

/// The scene that is asked for: a case, a file, or that of a golden folder, with what the command line says
/// about it. Throws `UsageError`, and what `load_scene` throws.
Scene scene_of(const CommandLine& given);

/// "here `cells = 64`, there `cells = 32`", for the first line in which two texts differ.
std::string first_different_line(const std::string& here, const std::string& there);

/// The options by which a scene is named and changed, and `more`.
std::vector<Option> scene_options(const std::vector<Option>& more);

/// Throws `UsageError` when the golden folder that --check names holds another scene. How often to write and
/// where to probe is not part of what is simulated: the scene's own is kept where all times of the golden
/// data are among its own; else the golden scene's is taken, unless the command line says otherwise.
void demand_same_scene(Scene& scene, const CommandLine& given);

/// The scene of the checkpoint, with a later end time where the command line asks for one. Throws
/// `UsageError` when the command line names another scene, and what `load_scene` throws.
Scene resumed_scene(const CommandLine& given, const Checkpoint& from);

/// Runs the scene, from a checkpoint where there is one, and does what the command line asks for with it. The
/// run is in its folder before errors are computed. A run that becomes invalid leaves its last valid
/// snapshot, marked as such. A signal that asks to end is answered with one line and the exit code 128 + its
/// number. Returns the exit code; throws what `run` throws, `FileError` and `UsageError`.
int run_scene(Scene scene, const CommandLine& given, std::optional<Checkpoint> from);

/// Where the run of the scene is written.
std::filesystem::path output_folder(const CommandLine& given, const Scene& scene);

/// "auto", "full" or "none", which --errors says. Throws `UsageError` for another word.
std::string errors_asked_for(const CommandLine& given);

/// Does the work, which computes a reference solution and tells it how far it is, as long as it takes, or
/// with "auto" as long as the run, which took so many seconds, or 2 s; false, and why, where it was not done.
/// Throws `Interrupted`.
bool within_budget(const std::string& asked, double seconds, bool quiet, std::string& reason,
                   const std::function<void(const ReferenceWatch&)>& work);

}  // namespace hompm::cli
