// Comma-separated tables: a header, then one row per particle and time; and snapshots for ParaView and
// meshio, one .vtu per time, with a .pvd that gives them a time axis.
#pragma once

#include <span>
#include <string>

#include <hompm/kit/output/text_file.hpp>
#include <hompm/simulation/records.hpp>

namespace hompm::detail {

/// `time,particle`, `body` where there are several, the names of `columns` and of `reported`. Throws
/// `FileError`.
void write_header(TextFile& file, std::span<const ParticleColumn> columns, bool several_bodies,
                  std::span<const ReportedField> reported = {});
/// One row per particle of `snapshot`, numbered from 0 through all bodies. Throws `FileError`, and `Error`
/// for a value that is not finite.
void write_rows(TextFile& file, std::span<const ParticleColumn> columns, const Snapshot& snapshot,
                std::span<const ReportedField> reported = {});

/// `time` and the names of the balances. Throws `FileError`.
void write_history_header(TextFile& file);
/// One row. Throws `FileError`, and `Error` for a value that is not finite.
void write_history_row(TextFile& file, const HistoryRow& row);

/// The header of probes.csv, and a row of it. The latter throws `Error` for a value that is not finite.
std::string probe_header();
std::string probe_text(const ProbeRow& row);

/// Path of snapshot `index` inside the run folder: "vtk/snapshot_0007.vtu".
std::string vtu_name(std::size_t index);

/// The particles as vertex cells at (x, 0, 0) with their fields as point data and the time as `TimeValue`.
/// ASCII with the shortest text of each number, which both readers turn back into the same bits; a subnormal
/// number is written as 0 of its sign. Throws `FileError`, and `Error` for a value that is not finite.
void write_vtu(TextFile& file, const Snapshot& snapshot);

/// The list of the snapshots, `times[i]` belonging to `vtu_name(i)`. Throws `FileError`.
void write_pvd(TextFile& file, std::span<const double> times);

}  // namespace hompm::detail
