// Runs one scene into its folder, and then compares it with its reference solution.
#pragma once

#include <optional>

#include <boost/program_options.hpp>

#include <hompm/recorder/checkpoint.hpp>

namespace hompm::cli {

/// Runs the scene, from a checkpoint where there is one, and does what the command line asks for with it. The
/// run is in its folder before errors are computed. A run that becomes invalid leaves its last valid
/// snapshot, marked as such. A signal that asks to end is answered with one line and the exit code 128 + its
/// number. Returns the exit code; throws what `run` throws, `FileError` and `UsageError`.
int run_scene(Scene scene, const boost::program_options::variables_map& given,
              std::optional<Checkpoint> from);

}  // namespace hompm::cli
