#include <hompm/number.hpp>
#include <hompm/output/csv.hpp>

namespace hompm::detail {

void write_header(TextFile& file, std::span<const ParticleColumn> columns, bool several_bodies,
                  std::span<const ReportedField> reported) {
  file << "time,particle" << (several_bodies ? ",body" : "");
  for (const auto& column : columns) file << "," << column.name;
  for (const auto& field : reported) file << "," << field.name;
  file << "\n";
}

void write_rows(TextFile& file, std::span<const ParticleColumn> columns, const Snapshot& snapshot,
                std::span<const ReportedField> reported) {
  const std::string time = to_text(snapshot.time);
  for (std::size_t particle = 0; particle < snapshot.size(); ++particle) {
    file << time << "," << particle;
    if (!snapshot.body.empty()) file << "," << static_cast<std::size_t>(snapshot.body[particle]);
    for (const auto& column : columns) file << "," << (snapshot.*column.values)[particle];
    for (const auto& field : reported) file << "," << field.values[particle];
    file << "\n";
  }
}

void write_history_header(TextFile& file) {
  file << "time";
  for (const auto& column : history_columns) file << "," << column.name;
  file << "\n";
}

void write_history_row(TextFile& file, const HistoryRow& row) {
  file << row.time;
  for (const auto& column : history_columns) file << "," << row.*column.value;
  file << "\n";
}

}  // namespace hompm::detail
