// The columns of the result files, once: what the writers put there is what the comparison looks for.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include <hompm/simulation/records.hpp>

namespace hompm::detail {

/// A field of the particles under the name it has in every file.
struct ParticleColumn {
  std::string_view name;
  std::vector<double> Snapshot::*values;
};

/// All fields of the particles; after `time,particle` the columns of invalid/last_valid.csv.
inline constexpr std::array<ParticleColumn, 8> all_columns{{{"X", &Snapshot::reference_position},
                                                            {"x", &Snapshot::position},
                                                            {"displacement", &Snapshot::displacement},
                                                            {"velocity", &Snapshot::velocity},
                                                            {"volume", &Snapshot::volume},
                                                            {"density", &Snapshot::density},
                                                            {"stress", &Snapshot::stress},
                                                            {"stretch", &Snapshot::stretch}}};

/// particles.csv after `time,particle`: X … density.
inline constexpr auto particle_columns = std::span(all_columns).first<6>();

/// stress.csv after `time,particle`.
inline constexpr std::array<ParticleColumn, 4> stress_columns{
    {all_columns[0], all_columns[1], all_columns[6], all_columns[7]}};

/// Point data of a .vtu: displacement … stretch.
inline constexpr auto point_data = std::span(all_columns).last<6>();

/// A balance under the name it has in history.csv.
struct HistoryColumn {
  std::string_view name;
  double HistoryRow::*value;
};

/// history.csv after `time`.
inline constexpr std::array<HistoryColumn, 11> history_columns{
    {{"kinetic", &HistoryRow::kinetic},
     {"stored", &HistoryRow::stored},
     {"gravity", &HistoryRow::gravity},
     {"dissipated", &HistoryRow::dissipated},
     {"external_work", &HistoryRow::external_work},
     {"residual", &HistoryRow::residual},
     {"momentum", &HistoryRow::momentum},
     {"impulse", &HistoryRow::impulse},
     {"momentum_residual", &HistoryRow::momentum_residual},
     {"mass", &HistoryRow::mass},
     {"internal_force_sum", &HistoryRow::internal_force_sum}}};

}  // namespace hompm::detail
