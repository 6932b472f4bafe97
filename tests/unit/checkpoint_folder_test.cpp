// Checkpoints in a run folder: a full disk, two runs at once, and what killed runs leave over.
#include <filesystem>
#include <string>
#include <unistd.h>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/kit/output/run_folder.hpp>
#include <hompm/kit/recorder/checkpoint.hpp>

#include "support/catch.hpp"
#include "support/file_size_limit.hpp"
#include "support/message_of.hpp"
#include "support/sample_run.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using namespace hompm::test;
using hompm::CheckpointWriter;
using hompm::RunFolder;

TEST_CASE("a checkpoint that cannot be written does not stop the run, and the one before stays") {
  const TemporaryFolder scratch;
  auto checkpoint = hompm::first_checkpoint(built_in("bar", "large", {{"scheme.cells", "8"}}));
  std::vector<std::string> warnings;
  RunFolder folder(scratch.path(), false);
  CheckpointWriter writer(folder, checkpoint, [&](const std::string& text) { warnings.push_back(text); });
  const auto write = [&](std::int64_t step) {
    checkpoint.point.states.front().step = step;
    writer.write(checkpoint.point, 0.0);
  };
  const auto step_on_disk = [&] { return hompm::read_checkpoint(scratch.path()).point.states.front().step; };
  {
    const FileSizeLimit full(1000);
    write(1);
    CHECK_FALSE(fs::exists(scratch / hompm::checkpoint_name));
  }
  write(2);
  CHECK(step_on_disk() == 2);
  {
    const FileSizeLimit full(1000);
    write(3);
    write(4);
  }
  CHECK(step_on_disk() == 2);
  write(5);
  CHECK(step_on_disk() == 5);
  const std::string reason =
      ": cannot write " + (scratch / "checkpoint.hompm").string() + ": File too large; the run goes on, ";
  CHECK(warnings ==
        std::vector<std::string>{"no checkpoint at step 1" + reason + "there is none of it yet",
                                 "no checkpoint at step 3" + reason + "the last checkpoint is of step 2"});

  folder.write(sample_snapshot(0.0, 2));  // the run itself took no harm
  folder.publish();
  CHECK(fs::exists(scratch / "particles.csv"));
  CHECK_FALSE(fs::exists(scratch / hompm::checkpoint_name));
}

TEST_CASE("a run that becomes invalid needs its checkpoint no more") {
  const TemporaryFolder scratch;
  RunFolder folder(scratch.path(), false);
  folder.write_checkpoint("bytes");
  folder.keep_invalid(sample_snapshot(0.0, 2), "unstable");
  CHECK_FALSE(fs::exists(scratch / hompm::checkpoint_name));
}

TEST_CASE("the checkpoint is there until the run is complete, whatever fails") {
  const TemporaryFolder scratch;
  fs::create_directories(scratch / "particles.csv/in the way");
  {
    RunFolder folder(scratch.path(), false);
    folder.write_checkpoint("bytes");
    folder.write("run.json", "{}");
    CHECK_THROWS_AS(folder.publish(), hompm::FileError);
  }
  CHECK(read_file(scratch / hompm::checkpoint_name) == "bytes");
}

TEST_CASE("what a killed run left over goes with the next run") {
  const TemporaryFolder scratch;
  write_file(scratch / ".hompm-partial-1/vtk/snapshot_0000.vtu", "left over");
  write_file(scratch / ".hompm-lock", "");
  const auto mine = ".hompm-partial-" + std::to_string(::getpid());
  {
    const RunFolder run(scratch.path(), false);
    CHECK_FALSE(fs::exists(scratch / ".hompm-partial-1"));
    CHECK(fs::exists(scratch / mine));
  }
  CHECK(fs::is_empty(scratch.path()));
}
