// Writes the checkpoints of a run into its folder.
#pragma once

#include <functional>
#include <string>

#include <hompm/output/run_folder.hpp>
#include <hompm/recorder/checkpoint.hpp>

namespace hompm {

/// Keeps what a run reports, and writes it with each point. A checkpoint that cannot be written does not stop
/// the run: the one before stays, and `warn` is told, once until it succeeds again.
class CheckpointWriter {
 public:
  /// `checkpoint` says what does not change, and what was reported before a restart.
  CheckpointWriter(RunFolder& folder, Checkpoint checkpoint, std::function<void(const std::string&)> warn);

  void keep(const HistoryRow& row) { checkpoint_.history.push_back(row); }
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
