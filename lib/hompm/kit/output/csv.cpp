#include <cmath>
#include <limits>
#include <string_view>

#include <hompm/kit/output/csv.hpp>
#include <hompm/number.hpp>

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

std::string probe_header() {
  std::string text = "time,probe";
  for (const auto& column : probe_columns) text.append(",").append(column.name);
  return text + "\n";
}

std::string probe_text(const ProbeRow& row) {
  std::string text = to_text(row.time) + "," + std::to_string(row.probe);
  for (const double value : row.values) text += "," + to_text(value);
  return text + "\n";
}

namespace {

/// One data array, a line per entry; `write_entry(i)` writes entry i.
template <class WriteEntry>
void write_array(TextFile& file, std::string_view attributes, std::size_t entries, WriteEntry write_entry) {
  file << "<DataArray " << attributes << " format=\"ascii\">\n";
  for (std::size_t i = 0; i < entries; ++i) {
    write_entry(i);
    file << "\n";
  }
  file << "</DataArray>\n";
}

/// Below the normal numbers there is 0: readers built on libc++ stop at what strtod calls out of range.
double readable(double value) {
  return std::abs(value) < std::numeric_limits<double>::min() ? std::copysign(0.0, value) : value;
}

}  // namespace

std::string vtu_name(std::size_t index) {
  std::string digits = std::to_string(index);
  if (digits.size() < 4) digits.insert(0, 4 - digits.size(), '0');
  return "vtk/snapshot_" + digits + ".vtu";
}

void write_vtu(TextFile& file, const Snapshot& snapshot) {
  const std::size_t n = snapshot.size();
  file << "<?xml version=\"1.0\"?>\n"
          "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
          "<UnstructuredGrid>\n<FieldData>\n";
  write_array(file, "type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\"", 1,
              [&](std::size_t) { file << readable(snapshot.time); });
  file << "</FieldData>\n<Piece NumberOfPoints=\"" << n << "\" NumberOfCells=\"" << n << "\">\n<PointData>\n";
  for (const auto& field : point_data) {
    write_array(file, "type=\"Float64\" Name=\"" + std::string(field.name) + "\"", n,
                [&](std::size_t i) { file << readable((snapshot.*field.values)[i]); });
  }
  for (const auto& field : snapshot.reported)
    write_array(file, "type=\"Float64\" Name=\"" + field.name + "\"", n,
                [&](std::size_t i) { file << readable(field.values[i]); });
  write_array(file, "type=\"Int64\" Name=\"particle\"", n, [&](std::size_t i) { file << i; });
  if (!snapshot.body.empty())
    write_array(file, "type=\"Int64\" Name=\"body\"", n,
                [&](std::size_t i) { file << static_cast<std::size_t>(snapshot.body[i]); });
  file << "</PointData>\n<Points>\n";
  write_array(file, "type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", n,
              [&](std::size_t i) { file << readable(snapshot.position[i]) << " 0 0"; });
  file << "</Points>\n<Cells>\n";
  write_array(file, "type=\"Int64\" Name=\"connectivity\"", n, [&](std::size_t i) { file << i; });
  write_array(file, "type=\"Int64\" Name=\"offsets\"", n, [&](std::size_t i) { file << i + 1; });
  write_array(file, "type=\"UInt8\" Name=\"types\"", n, [&](std::size_t) { file << "1"; });  // VTK_VERTEX
  file << "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

void write_pvd(TextFile& file, std::span<const double> times) {
  file << "<?xml version=\"1.0\"?>\n"
          "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n";
  for (std::size_t i = 0; i < times.size(); ++i)
    file << "<DataSet timestep=\"" << readable(times[i]) << "\" part=\"0\" file=\"" << vtu_name(i)
         << "\"/>\n";
  file << "</Collection>\n</VTKFile>\n";
}

}  // namespace hompm::detail
