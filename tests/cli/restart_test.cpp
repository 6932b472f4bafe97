// hompm-run --checkpoint and --resume as users meet them.
#include <filesystem>
#include <map>
#include <string>

#include "support/catch.hpp"
#include "support/run_command.hpp"

using namespace hompm::test;
namespace fs = std::filesystem;

namespace {

const std::string tool = HOMPM_BIN_DIR "/hompm-run";
/// A run of 2000 steps: some 40 ms.
const std::string scene = " --case bar --cells 8 --end-time 0.2 --snapshots 5 --probe 10 --probe right";

/// Files of `folder` with their content but for the wall clock, by name.
std::map<std::string, std::string> content(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().filename() != "timing.json")
      files[fs::relative(entry.path(), folder).string()] = read_file(entry.path());
  return files;
}

/// A folder with the checkpoint of a run that was killed as soon as there was one.
void kill_early(const fs::path& folder, const std::string& options) {
  const std::string file = quoted((folder / "checkpoint.hompm").string());
  // Steps enough to be still under way when it is killed; what it was asked to do does not depend on that.
  run_command(tool + options + " --quiet --output " + quoted(folder.string()) +
              " & run=$!; while kill -0 $run && [ ! -e " + file +
              " ]; do sleep 0.005; done; kill -KILL $run; wait $run");
  REQUIRE(fs::exists(folder / "checkpoint.hompm"));
}

}  // namespace

TEST_CASE("a killed run is resumed in its folder, or in another, and ends with the same bytes") {
  const TemporaryFolder scratch;
  REQUIRE(run_command(tool + scene + " --output " + quoted(scratch / "whole")).exit_code == 0);
  kill_early(scratch / "killed", scene + " --checkpoint 10");
  fs::copy(scratch / "killed/checkpoint.hompm", scratch / "copy");

  const auto elsewhere =
      run_command(tool + " --resume " + quoted(scratch / "copy") + " --output " + quoted(scratch / "other"));
  INFO(elsewhere.err);
  CHECK(elsewhere.exit_code == 0);
  CHECK((content(scratch / "other") == content(scratch / "whole")));

  // the folder is as good as the file in it, and naming the scene again does no harm
  const auto here = run_command(tool + scene + " --resume " + quoted(scratch / "killed"));
  INFO(here.err);
  CHECK(here.exit_code == 0);
  CHECK((content(scratch / "killed") == content(scratch / "whole")));

  const auto again = run_command(tool + " --resume " + quoted(scratch / "killed"));
  CHECK(again.exit_code == 5);
  CHECK_THAT(again.err, contains("there is no checkpoint, and the run in") && contains("is complete"));
}

TEST_CASE("who forgets --resume is told") {
  const TemporaryFolder scratch;
  write_file(scratch / "checkpoint.hompm", "of a run that was stopped");
  const std::string again = tool + scene + " --no-vtk --output " + quoted(scratch.path().string());
  CHECK_THAT(run_command(again).err, contains("hompm-run: warning: the run that was stopped in ") &&
                                         contains("is replaced (--resume "));
  CHECK(run_command(again).err.empty());
}

TEST_CASE("a resumed run writes no vtk files where the first was not asked for them") {
  const TemporaryFolder scratch;
  kill_early(scratch / "killed", scene + " --no-vtk --checkpoint 10");
  CHECK(run_command(tool + " --resume " + quoted(scratch / "killed")).exit_code == 0);
  CHECK_FALSE(fs::exists(scratch / "killed/vtk"));
}

TEST_CASE("what cannot be resumed: a reason, exit 2 or 5, nothing written") {
  const TemporaryFolder scratch;
  kill_early(scratch / "killed", scene + " --checkpoint 10");
  const std::string good = read_file(scratch / "killed/checkpoint.hompm");
  const std::string here =
      "cd " + quoted(scratch.path().string()) + " && " + tool + " --output out --resume ";
  write_file(scratch / "short", good.substr(0, good.size() / 2));
  std::string bad = good;
  bad[bad.size() / 2] = static_cast<char>(bad[bad.size() / 2] ^ 4);
  write_file(scratch / "bad", bad);
  write_file(scratch / "scene.toml", "end_time = 1\n");
  write_file(scratch / "good", good);
  struct Refused {
    std::string arguments, message;
    int exit_code;
  };
  for (const auto& [arguments, message, exit_code] :
       {Refused{"short", "cannot resume from short: it is cut short", 5},
        Refused{"bad", "cannot resume from bad: it is damaged", 5},
        Refused{"scene.toml", "cannot resume from scene.toml: it is not a checkpoint of hompm", 5},
        Refused{"none", "cannot read none: No such file", 5},
        Refused{"good --cells 9",
                "--cells 9: --resume goes on with the scene in the checkpoint, of which only end_time", 2},
        Refused{"good --end-time 0.1", "end_time = 0.1 is before that of the checkpoint, 0.2 s", 2},
        Refused{"good --case bar --cells 9 --end-time 0.2 --snapshots 5",
                "another scene: here `cells = 9`, there `cells = 8`", 2},
        Refused{"good --case column", "a checkpoint of another scene", 2}}) {
    const auto done = run_command(here + arguments);
    INFO(arguments << " -> " << done.err);
    CHECK(done.exit_code == exit_code);
    CHECK_THAT(done.err, contains(message));
    CHECK(done.out.empty());
    CHECK_FALSE(fs::exists(scratch / "out"));
  }
}

TEST_CASE("an interval that is none: exit 2, nothing written") {
  const TemporaryFolder scratch;
  for (const char* every : {"0", "-5", "10min", "1e3", "99999999999999999999"}) {
    const auto done = run_command("cd " + quoted(scratch.path().string()) + " && " + tool + scene +
                                  " --checkpoint " + every);
    CHECK(done.exit_code == 2);
    CHECK_THAT(done.err, contains(std::string("--checkpoint ") + every + ": expected a number of steps"));
    CHECK(fs::is_empty(scratch.path()));
  }
}

TEST_CASE("with no room for checkpoints the run ends well, and says so on one line") {
  const TemporaryFolder scratch;
  // 512-byte blocks: room for each file of the results, not for the checkpoint with all of them
  const auto done =
      run_command("trap '' XFSZ; ulimit -f 16; " + tool +
                  " --case bar --cells 8 --end-time 0.2 --scheme bspline --degree 5 --snapshots 1 --no-vtk"
                  " --set output.history=3 --checkpoint 100 --output " +
                  quoted(scratch / "out"));
  INFO(done.err);
  CHECK(done.exit_code == 0);
  CHECK_THAT(done.err, contains("hompm-run: warning: no checkpoint at step 100: cannot write ") &&
                           contains("File too large; the run goes on"));
  CHECK(std::count(done.err.begin(), done.err.end(), '\n') == 1);
  CHECK(fs::exists(scratch / "out/run.json"));
}

TEST_CASE("a second run that wants the same checkpoint is refused while the first is under way") {
  const TemporaryFolder scratch;
  const std::string out = quoted((scratch / "out").string());
  const auto done =
      run_command(tool + " --case bar --end-time 1000 --checkpoint 10 --quiet --output " + out +
                  " & run=$!; while kill -0 $run && [ ! -e " + out +
                  "/checkpoint.hompm ]; do sleep 0.005; done; " + tool + scene +
                  " --checkpoint 10 --output " + out + "; code=$?; kill -KILL $run; wait $run; exit $code");
  CHECK(done.exit_code == 5);
  CHECK_THAT(done.err, contains("another run is writing there"));
}
