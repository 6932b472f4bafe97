// How much memory a run takes, and how much there is: told before it begins.
#pragma once

#include <cstdint>

#include <hompm/scene/scene.hpp>

namespace hompm::cli {

/// What a run keeps beside its state.
struct Keeps {
  bool checkpoints = false;  ///< all that was reported
  bool trace = false;        ///< the state before each stage
};

/// About how many bytes a run takes at least: measured for every scheme, and found to be linear.
double estimated_memory(const Scene& scene, const Keeps& keeps);

/// Throws `SceneError` with both numbers when that is more than this process may have: physical memory, the
/// limits of its address space (ulimit -v) and data, and those of its control group.
void demand_memory(const Scene& scene, const Keeps& keeps);

}  // namespace hompm::cli
