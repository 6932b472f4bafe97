// Comma-separated tables: a header, then one row per particle and time.
#pragma once

#include <span>

#include <hompm/output/text_file.hpp>
#include <hompm/simulation/columns.hpp>

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

}  // namespace hompm::detail
