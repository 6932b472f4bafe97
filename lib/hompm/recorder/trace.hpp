// The flight recorder of a run: a hash for each step, stage and field, from which two runs can be compared.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

#include <hompm/simulation/simulation.hpp>

namespace hompm {

struct TraceOptions {
  std::int64_t values_from = 0;                       ///< first step of which all values are written, too
  std::size_t values_bytes = std::size_t{16} << 20U;  ///< no step begins to be written beyond that
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

}  // namespace hompm
