// Particle results as other codes write them, and those of a golden folder, by time and in order of X.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <hompm/kit/verify/table.hpp>

namespace hompm::detail {

/// Particles at one time, in order of body, then X.
struct ParticleBlock {
  double time = 0.0;                        ///< s
  std::vector<std::int64_t> body;           ///< of each particle; empty where bodies are not told apart
  std::vector<double> X;                    ///< m, no two equal in a body
  std::vector<std::vector<double>> values;  ///< by field, one entry per particle; NaN where unreadable
};

/// Columns of particle fields.
struct ParticleFields {
  std::vector<std::string> names;
  std::vector<ParticleBlock> blocks;  ///< by time

  /// Where `name` stands; the number of names when it does not.
  [[nodiscard]] std::size_t index_of(const std::string& name) const;
  [[nodiscard]] bool has(const std::string& name) const { return index_of(name) < names.size(); }
  /// Values of a field that is there, at a time that is.
  [[nodiscard]] const std::vector<double>& values(const std::string& name, std::size_t time) const {
    return blocks[time].values[index_of(name)];
  }
  /// Largest magnitude of a field that is there, at any time.
  [[nodiscard]] double largest(const std::string& name) const;
  /// Puts u = x − X in the place of the displacement; nothing where there are no positions.
  void derive_displacement();
};

/// A lenient table with particles in its rows.
class ParticleTable {
 public:
  /// Opens `path`, finds the particles' fields that are there, and collects the times. X may follow from x
  /// and displacement, or from the particle's number and its x at the first time. Rows of the same X are
  /// averaged where every particle has several: strips of 2D and 3D codes. What is wrong goes to `faults`,
  /// what is worth knowing to `notes`. Throws `FileError` when the file cannot be read, or nothing in it
  /// compared.
  ParticleTable(const std::filesystem::path& path, TableLayout layout, MessageLog& faults, MessageLog& notes);

  /// Distinct times in the file, ascending, s.
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  /// The fields that the file has.
  [[nodiscard]] const std::vector<std::string>& fields() const { return fields_; }
  [[nodiscard]] const Table& table() const { return table_; }

  /// The particles at `times`, which must be ascending and among `times()`. Memory goes by the rows at these
  /// times, not by the file. Throws `FileError`.
  std::vector<ParticleBlock> read(std::span<const double> times);

  /// Adds a message about the file as a whole; see `MessageLog`.
  void fault(const std::string& kind, const std::string& text) { table_.fault(kind, 0, text); }
  void note(const std::string& text) { table_.note(text, 0, text); }
  void note(const std::string& kind, const std::string& text) { table_.note(kind, 0, text); }

 private:
  [[nodiscard]] bool has(std::size_t field) const { return table_.has(field); }
  void require_columns();
  void collect_times();
  double X_of(const Row& row);
  void sort(ParticleBlock& block);

  Table table_;
  std::vector<std::string> fields_;
  std::vector<std::size_t> columns_;  // of fields_, in the layout
  std::vector<double> times_;
  std::map<double, double> first_x_;  // by particle, where X follows from it
};

/// The particles' fields that are compared, as the table of columns has them: x … stretch.
const std::vector<std::string>& particle_fields();

/// particles.csv and stress.csv of `folder` together. Throws `FileError` when both are missing or cannot be
/// read.
ParticleFields read_golden(const std::filesystem::path& folder, MessageLog& faults, MessageLog& notes);

}  // namespace hompm::detail
