#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <unistd.h>

#include <hompm/error.hpp>
#include <hompm/kit/output/run_folder.hpp>
#include <hompm/number.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/run_command.hpp"
#include "support/sample_run.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using namespace hompm::test;
using hompm::RunFolder;

namespace {

/// All files below `folder`, by relative name.
std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_directory()) names.insert(fs::relative(entry.path(), folder).string());
  }
  return names;
}

}  // namespace

TEST_CASE("the results are plain CSV with the shortest text of every number", "[output]") {
  const TemporaryFolder folder;
  hompm::Snapshot snapshot;
  snapshot.time = 0.1;
  snapshot.reference_position = {0.5, 1.5};
  snapshot.position = {0.30000000000000004, 1e22};
  snapshot.displacement = {-0.0, 5e-324};
  snapshot.velocity = {1.7976931348623157e308, -1.0 / 3.0};
  snapshot.volume = {1.0, 2.0};
  snapshot.density = {1000.0, 123456789.0};
  snapshot.stress = {-1e-7, 0.0};
  snapshot.stretch = {1.0, 0.1};
  RunFolder run(folder.path(), false);
  run.write(snapshot);
  run.write(sample_history(0.0));
  run.publish();
  CHECK(read_file(folder / "particles.csv") ==
        "time,particle,X,x,displacement,velocity,volume,density\n"
        "0.1,0,0.5,0.30000000000000004,-0,1.7976931348623157e+308,1,1000\n"
        "0.1,1,1.5,1e+22,5e-324,-0.3333333333333333,2,123456789\n");
  CHECK(read_file(folder / "stress.csv") ==
        "time,particle,X,x,stress,stretch\n"
        "0.1,0,0.5,0.30000000000000004,-1e-07,1\n"
        "0.1,1,1.5,1e+22,0,0.1\n");
  CHECK(
      read_file(folder / "history.csv") ==
      "time,kinetic,stored,gravity,dissipated,external_work,residual,momentum,impulse,momentum_residual,mass,"
      "internal_force_sum\n"
      "0,0,0,-0,0,0,0,0,0,0,25,1e-17\n");
}

TEST_CASE("a snapshot larger than the write buffer arrives whole", "[output]") {
  const TemporaryFolder folder;
  const std::size_t particles = 20000;
  write_sample_run(folder.path(), particles);
  std::string expected = "time,particle,X,x,stress,stretch\n";
  for (const double time : {0.0, 0.1, 0.25}) {
    const auto snapshot = sample_snapshot(time, particles);
    for (std::size_t i = 0; i < particles; ++i) {
      expected += hompm::to_text(time) + "," + std::to_string(i);
      for (const auto* values :
           {&snapshot.reference_position, &snapshot.position, &snapshot.stress, &snapshot.stretch}) {
        expected += "," + hompm::to_text((*values)[i]);
      }
      expected += "\n";
    }
  }
  CHECK((read_file(folder / "stress.csv") == expected));  // parentheses: a megabyte is not to be printed
}

TEST_CASE("files appear only when the run is published", "[output]") {
  const TemporaryFolder folder;
  const std::string staging = ".hompm-partial-" + std::to_string(::getpid());
  RunFolder run(folder.path(), true);
  run.write(sample_snapshot(0.0, 3));
  run.write("run.json", "{}\n");
  for (const auto& name : files_in(folder.path())) {
    INFO(name);
    CHECK((name == ".hompm-lock" || name.starts_with(staging + "/")));
  }
  run.publish();
  CHECK(files_in(folder.path()) == std::set<std::string>{".hompm-lock", "history.csv", "particles.csv",
                                                         "run.json", "run.pvd", "stress.csv",
                                                         "vtk/snapshot_0000.vtu"});
  CHECK_FALSE(message_of<hompm::Error>([&] { run.publish(); }).empty());
}

TEST_CASE("a run that is not published leaves no trace", "[output]") {
  const TemporaryFolder folder;
  SECTION("in folders it created") {
    { RunFolder(folder / "a/b/c", true).write(sample_snapshot(0.0, 3)); }
    CHECK(fs::is_empty(folder.path()));
  }
  SECTION("in a folder that was there, empty") {
    fs::create_directory(folder / "mine");
    { RunFolder(folder / "mine/", false).write(sample_history(0.0)); }
    CHECK(fs::is_directory(folder / "mine"));
    CHECK(fs::is_empty(folder / "mine"));
  }
  SECTION("in a folder with an earlier run") {
    write_sample_run(folder.path(), 4, true);
    const auto before = files_in(folder.path());
    const auto particles = read_file(folder / "particles.csv");
    { RunFolder(folder.path(), true).write(sample_snapshot(9.0, 2)); }
    CHECK(files_in(folder.path()) == before);
    CHECK(read_file(folder / "particles.csv") == particles);
  }
}

TEST_CASE("publishing replaces the earlier run and nothing else", "[output]") {
  const TemporaryFolder folder;
  {
    RunFolder invalid(folder.path(), false);
    invalid.keep_invalid(sample_snapshot(0.0, 2), "unstable");
  }
  write_sample_run(folder.path(), 4, true);
  CHECK_FALSE(fs::exists(folder / "invalid"));
  write_file(folder / "timing.json", "{}");
  const std::set<std::string> mine{"notes.txt",           "particles.csv.bak", "vtk/mine.vtu",
                                   "vtk/snapshot_x.vtu",  "vtk/snapshot_.vtu", "vtk/snapshot_0001.vtu.bak",
                                   "invalid/thoughts.txt"};
  for (const auto& name : mine) write_file(folder / name, "mine");

  RunFolder run(folder.path(), false);
  run.write(sample_snapshot(0.5, 1));
  run.write("run.json", "{\"new\": true}\n");
  run.publish();
  auto expected = mine;
  expected.insert({".hompm-lock", "history.csv", "particles.csv", "run.json", "stress.csv"});
  CHECK(files_in(folder.path()) == expected);
  CHECK(read_file(folder / "run.json") == "{\"new\": true}\n");
  for (const auto& name : mine) CHECK(read_file(folder / name) == "mine");
}

TEST_CASE("of two runs at a time in one folder the second is refused", "[output]") {
  const TemporaryFolder folder;
  const auto link = folder / "link";
  fs::create_directory_symlink(folder.path(), link);
  RunFolder first(folder.path(), false);
  for (const auto& same : {folder.path(), link})
    CHECK(message_of<hompm::FileError>([&] { RunFolder(same, false); }) ==
          "cannot write in " + same.string() +
              ": another run is writing there; wait for it, or choose another --output");
  { const RunFolder other(folder / "below", false); }
  first.write(sample_snapshot(1.0, 1));
  first.publish();
  CHECK(contains(read_file(folder / "particles.csv"), "\n1,0,"));
  CHECK(first.earlier_run() == "particles.csv");
  first.replace("run.json", "{}");  // of what was published; still under the lock
  CHECK(first.earlier_run() == "run.json");
}

TEST_CASE("an invalid run keeps its last valid snapshot and nothing that looks like a result", "[output]") {
  const TemporaryFolder folder;
  SECTION("in a new folder") {
    {
      RunFolder run(folder / "out", true);
      run.write(sample_snapshot(0.0, 2));
      run.keep_invalid(sample_snapshot(0.1, 2), "inverted at step 7");
      CHECK_FALSE(message_of<hompm::Error>([&] { run.publish(); }).empty());
    }
    CHECK(files_in(folder.path()) ==
          std::set<std::string>{"out/invalid/last_valid.csv", "out/invalid/reason.txt"});
    CHECK(read_file(folder / "out/invalid/reason.txt") == "inverted at step 7\n");
    std::istringstream rows(read_file(folder / "out/invalid/last_valid.csv"));
    std::string header, row;
    std::getline(rows, header);
    CHECK(header == "time,particle,X,x,displacement,velocity,volume,density,stress,stretch");
    std::getline(rows, row);
    CHECK(row.ends_with("," + hompm::to_text(sample_snapshot(0.1, 2).stretch[0])));
  }
  SECTION("over an earlier run, which could be taken for its result") {
    write_sample_run(folder.path(), 4, true);
    write_file(folder / "notes.txt", "the user's own");
    { RunFolder(folder.path(), true).keep_invalid(sample_snapshot(0.1, 2), "unstable"); }
    CHECK(files_in(folder.path()) ==
          std::set<std::string>{"notes.txt", "invalid/last_valid.csv", "invalid/reason.txt"});
  }
}

TEST_CASE("meshio reads the snapshots back bit for bit", "[output]") {
  const TemporaryFolder folder;
  const auto check = [&] {
    return run_command("/usr/bin/python3 " + quoted(HOMPM_SOURCE_DIR "/tests/cli/meshio_roundtrip.py") + " " +
                       quoted(folder.path().string()));
  };
  {
    RunFolder run(folder.path(), true);
    auto snapshot = sample_snapshot(0.0, 5);
    // Values that text formats like to spoil.
    snapshot.displacement = {-0.0, 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, 0.1 + 0.2};
    run.write(snapshot);
    run.write(sample_snapshot(1.0 / 3.0, 7));
    run.publish();
  }
  const auto good = check();
  if (good.exit_code == 77) {
    WARN("meshio is not installed");
    return;
  }
  INFO(good.out << good.err);
  CHECK(good.exit_code == 0);

  // The check itself must notice one bit, a missing snapshot and a wrong time.
  const auto damage = [&](const std::string& name, const std::string& from, const std::string& to) {
    const auto text = read_file(folder / name);
    REQUIRE(contains(text, from));
    auto damaged = text;
    write_file(folder / name, damaged.replace(damaged.find(from), from.size(), to));
    const auto result = check();
    INFO(name << ": " << result.out << result.err);
    CHECK(result.exit_code == 1);
    write_file(folder / name, text);
  };
  damage("vtk/snapshot_0000.vtu", "0.30000000000000004", "0.3");
  damage("vtk/snapshot_0000.vtu", "\n-0\n", "\n0\n");
  damage("vtk/snapshot_0001.vtu", "0.3333333333333333\n", "0.33333333333333337\n");
  damage("run.pvd", "snapshot_0001", "snapshot_0000");
  damage("run.pvd", "timestep=\"0.3333333333333333\"", "timestep=\"0.3\"");
}
