// The golden side of a comparison with another code.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <hompm/verify/foreign_table.hpp>
#include <hompm/verify/message_log.hpp>

namespace hompm::detail {

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

/// particles.csv and stress.csv of `folder` together. Throws `FileError` when both are missing.
ParticleFields read_golden(const std::filesystem::path& folder, MessageLog& faults, MessageLog& notes);

/// Indices of the blocks that are asked for by time (s), ascending; all when nothing is. Throws `OptionError`
/// for a time that is not there.
std::vector<std::size_t> wanted_blocks(const ParticleFields& golden, const std::vector<double>& asked);

}  // namespace hompm::detail
