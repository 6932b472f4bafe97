// The flight recorder of a run: a hash for each step, stage and field; and where two runs part, from their
// traces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <hompm/simulation/simulation.hpp>

namespace hompm {

struct TraceOptions {
  std::int64_t values_from = 0;                       ///< first step of which all values are written, too
  std::size_t values_bytes = std::size_t{16} << 20U;  ///< no step begins to be written beyond that
  /// If > 0, not a trace but a table is written: `step,part,stage,body,field,index,value`, all values of the
  /// start, and of so many steps those of each field that a stage changed.
  std::int64_t table_steps = 0;
};

/// Writes a trace: after each stage of the plan a hash of every field that the stage changed
/// (docs/tracing.md has the format). A run without one is not touched.
class Trace {
 public:
  explicit Trace(const std::filesystem::path& path, const TraceOptions& options = {});
  /// Ends the trace as far as that is possible.
  ~Trace();
  Trace(const Trace&) = delete;
  Trace& operator=(const Trace&) = delete;

  /// Opens the file, begins with the states that `simulation` has, and adds a stage of its own behind each
  /// stage of its plans and each of its couplings; they need this object as long as they run, and throw
  /// `FileError`, the file then being gone. To be called once.
  void attach(const Scene& scene, Simulation& simulation);
  /// Ends the trace. Throws `FileError`.
  void close();

 private:
  class Recorder;
  std::unique_ptr<Recorder> recorder_;
};

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
