// What a run reports: particle fields at output times, and balances over time; and the columns of the result
// files, once: what the writers put there is what the comparison looks for.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hompm {

/// A declared field that is reported; 0 for the particles of a body that has none of the name.
struct ReportedField {
  std::string name, unit;
  std::vector<double> values;
};

/// All particle fields at one time. All vectors have one entry per particle, ordered by body and reference
/// position.
struct Snapshot {
  double time = 0.0;                       ///< s
  std::vector<double> reference_position;  ///< X, m
  std::vector<double> position;            ///< x, m
  std::vector<double> displacement;        ///< u = x − X, m
  std::vector<double> velocity;            ///< m/s, at `time`
  std::vector<double> volume;              ///< m (unit cross-section)
  std::vector<double> density;             ///< kg/m³
  std::vector<double> stress;              ///< Cauchy stress, tension positive, Pa
  std::vector<double> stretch;             ///< λ = ∂x/∂X
  std::vector<ReportedField> reported;     ///< what effects and laws add, in the order of the bodies
  std::vector<std::int64_t> body;          ///< which body it belongs to, from 0; empty where there is one

  [[nodiscard]] std::size_t size() const { return position.size(); }
};

/// Energies in J/m², momenta in kg/(m s), mass in kg/m² (unit cross-section).
struct HistoryRow {
  double time = 0.0;           ///< s
  double kinetic = 0.0;        ///< ½ Σ m v²
  double stored = 0.0;         ///< Σ V0 ψ(λ)
  double gravity = 0.0;        ///< potential energy in the gravity field, zero at the start
  double dissipated = 0.0;     ///< by damping, since the start
  double external_work = 0.0;  ///< by tractions, since the start
  double residual =
      0.0;  ///< kinetic + stored + gravity + dissipated − external_work − their sum at the start
  double momentum = 0.0;  ///< Σ m v
  double impulse = 0.0;   ///< of gravity, tractions, damping and the reactions at fixed ends, since the start
  double momentum_residual = 0.0;   ///< momentum − momentum at the start − impulse
  double mass = 0.0;                ///< Σ m
  double internal_force_sum = 0.0;  ///< |Σ f_int| / Σ |f_int| over the grid functions
};

/// What is at a probe at one time.
struct ProbeRow {
  double time = 0.0;               ///< s
  std::size_t probe = 0;           ///< number in the scene, from 0
  std::array<double, 7> values{};  ///< by `probe_columns`
};

}  // namespace hompm

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

/// probes.csv after `time,probe`.
inline constexpr std::array<ParticleColumn, 7> probe_columns{{all_columns[0], all_columns[1], all_columns[2],
                                                              all_columns[3], all_columns[5], all_columns[6],
                                                              all_columns[7]}};

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
