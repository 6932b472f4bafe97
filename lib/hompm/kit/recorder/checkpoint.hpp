// A run under way in a file, from which it goes on as if it had never stopped.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <hompm/effects/registry.hpp>
#include <hompm/kit/output/csv.hpp>
#include <hompm/kit/output/run_folder.hpp>
#include <hompm/simulation/run.hpp>

namespace hompm {

/// A checkpoint that cannot be resumed from; `what()` names the file and says why.
class CheckpointError : public FileError {
 public:
  using FileError::FileError;
};

/// Of the layout of the bytes in a checkpoint; only this one is read.
inline constexpr std::uint64_t checkpoint_format = 5;

/// Everything a run is and has reported so far.
struct Checkpoint {
  Scene scene;
  std::int64_t every = 0;       ///< steps between two checkpoints
  bool vtk = true;              ///< vtk files were asked for
  bool keep = false;            ///< one at the end was asked for
  std::string errors = "auto";  ///< which errors were asked for: auto, full, none
  double seconds = 0.0;         ///< on the wall clock so far
  std::vector<HistoryRow> history;
  std::vector<Snapshot> snapshots;
  std::string probes;  ///< rows of probes.csv
  RunPoint point;
};

/// A checkpoint of a run that has not begun: nothing reported, the state at t = 0.
Checkpoint first_checkpoint(const Scene& scene);

/// The checkpoint as bytes, the same on every machine: a header, the length and a hash of the rest
/// (recorder/bytes.hpp), and the rest, every value little-endian. Bound to the version and the commit of this
/// build: another one may compute other bits.
std::string checkpoint_bytes(const Checkpoint& checkpoint);

/// What `checkpoint_bytes` gave; `source` is the name of the file in messages, `effects` what its scene may
/// call for, which must outlive it. Throws `CheckpointError` for anything that is not a whole checkpoint of
/// this version and commit.
Checkpoint parse_checkpoint(const std::string& bytes, const std::string& source,
                            const EffectCatalogue& effects = effect_catalogue());

/// The run folder in which the checkpoint `path` lies; `path` may be that folder.
std::filesystem::path checkpoint_folder(const std::filesystem::path& path);

/// The checkpoint in the file `path`, or in the run folder `path`. Throws `FileError` when it cannot be read,
/// else as above.
Checkpoint read_checkpoint(const std::filesystem::path& path,
                           const EffectCatalogue& effects = effect_catalogue());

/// Keeps what a run reports, and writes it with each point. A checkpoint that cannot be written does not stop
/// the run: the one before stays, and `warn` is told, once until it succeeds again.
class CheckpointWriter {
 public:
  /// `checkpoint` says what does not change, and what was reported before a restart.
  CheckpointWriter(RunFolder& folder, Checkpoint checkpoint, std::function<void(const std::string&)> warn);

  void keep(const HistoryRow& row) { checkpoint_.history.push_back(row); }
  void keep(const ProbeRow& row) { checkpoint_.probes += detail::probe_text(row); }
  void keep(const Snapshot& snapshot) { checkpoint_.snapshots.push_back(snapshot); }
  /// `seconds` on the wall clock so far.
  void write(const RunPoint& point, double seconds);
  /// The step of the last one in the folder, 0 for none.
  [[nodiscard]] std::int64_t written() const { return written_; }

 private:
  RunFolder& folder_;
  Checkpoint checkpoint_;
  std::function<void(const std::string&)> warn_;
  std::int64_t written_;
  bool failing_ = false;
};

}  // namespace hompm
