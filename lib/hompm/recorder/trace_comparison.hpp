// Where two runs part, from their traces.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hompm {

/// One value of a field, in both runs.
struct TraceValues {
  std::string place;           ///< "particle 12", "grid function 3"; "" for a field of one value
  std::uint64_t a, b;          ///< their bits
  std::string text_a, text_b;  ///< shortest decimal
  std::uint64_t distance;      ///< in ulps; of integers the difference
  bool is_integer;
  std::size_t differing, size;  ///< values of the field that differ, and all
};

struct TraceDifference {
  std::int64_t step;
  int part;  ///< of the step, from 1; 0 in the state with which the traces begin
  std::string stage;
  std::string called_by;
  std::string field;
  std::optional<std::size_t> body;    ///< whose field it is, in a scene of several
  std::optional<TraceValues> values;  ///< first that differ; none when they are not in both traces
  std::string missing_in;             ///< then "A", "B" or "A and B"
};

struct TraceComparison {
  bool identical = true;
  std::optional<TraceDifference> first;
  std::vector<std::string> messages;           ///< other differences
  std::vector<std::string> notes;              ///< what else may matter
  std::int64_t first_step = 0, last_step = 0;  ///< that were compared
};

/// Compares two traces from the later of the two beginnings to the first difference. Throws `FileError` when
/// one cannot be read, is no trace, or is damaged.
TraceComparison compare_traces(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace hompm
