// Snapshots for ParaView and meshio: one .vtu per time, and a .pvd that gives them a time axis.
#pragma once

#include <span>
#include <string>

#include <hompm/output/text_file.hpp>
#include <hompm/simulation/records.hpp>

namespace hompm::detail {

/// Path of snapshot `index` inside the run folder: "vtk/snapshot_0007.vtu".
std::string vtu_name(std::size_t index);

/// The particles as vertex cells at (x, 0, 0) with their fields as point data and the time as `TimeValue`.
/// ASCII with the shortest text of each number, which both readers turn back into the same bits; a subnormal
/// number is written as 0 of its sign. Throws `FileError`, and `Error` for a value that is not finite.
void write_vtu(TextFile& file, const Snapshot& snapshot);

/// The list of the snapshots, `times[i]` belonging to `vtu_name(i)`. Throws `FileError`.
void write_pvd(TextFile& file, std::span<const double> times);

}  // namespace hompm::detail
