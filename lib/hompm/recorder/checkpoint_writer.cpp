#include <utility>

#include <hompm/recorder/checkpoint_writer.hpp>

namespace hompm {

CheckpointWriter::CheckpointWriter(RunFolder& folder, Checkpoint checkpoint,
                                   std::function<void(const std::string&)> warn)
    : folder_(folder),
      checkpoint_(std::move(checkpoint)),
      warn_(std::move(warn)),
      written_(checkpoint_.point.states.front().step) {}

void CheckpointWriter::write(const RunPoint& point, double seconds) {
  checkpoint_.point = point;
  checkpoint_.seconds = seconds;
  try {
    folder_.write_checkpoint(checkpoint_bytes(checkpoint_));
    written_ = point.states.front().step;
    failing_ = false;
  } catch (const FileError& error) {
    if (!failing_)
      warn_("no checkpoint at step " + std::to_string(point.states.front().step) + ": " + error.what() +
            "; the run goes on, " +
            (written_ > 0 ? "the last checkpoint is of step " + std::to_string(written_)
                          : std::string("there is none of it yet")));
    failing_ = true;
  }
}

}  // namespace hompm
