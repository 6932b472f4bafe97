// hompm-run --trace and hompm-diff --trace as users meet them.
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "support/catch.hpp"
#include "support/run_command.hpp"

using namespace hompm::test;
namespace fs = std::filesystem;

namespace {

const std::string tool = HOMPM_BIN_DIR "/hompm-run --quiet --no-vtk --output out ";
const std::string diff = HOMPM_BIN_DIR "/hompm-diff --trace ";
const std::string scene = "--case bar --cells 8 --end-time 0.01 ";

}  // namespace

TEST_CASE("two runs are traced and compared: 0 identical, 3 with the place at which they part") {
  const TemporaryFolder scratch;
  const auto here = [&](const std::string& command) {
    return run_command("cd " + quoted(scratch.path().string()) + " && " + command);
  };
  REQUIRE(here(tool + scene + "--trace a").exit_code == 0);
  REQUIRE(here(tool + scene + "--trace b").exit_code == 0);
  const auto same = here(diff + "a b");
  CHECK(same.exit_code == 0);
  CHECK(same.out == "identical\nsteps 0 to 100: every field after every stage\n");
  CHECK(here(diff + "--quiet a b").out.empty());

  REQUIRE(here(tool + scene + "--set initial.velocity.amplitude=1.0000000000000002 --trace b").exit_code ==
          0);
  const auto other = here(diff + "a b");
  CHECK(other.exit_code == 3);
  CHECK_THAT(other.out,
             contains("different\nfirst difference: step 0, the state with which the traces begin, "
                      "particles.velocity, particle "));
  CHECK_THAT(other.out, contains("\n  A  0x3f") && contains("2 ulps apart; ") &&
                            contains(" of the 32 values") &&
                            contains("note: the scenes differ: `amplitude = 1.0  # m/s` in A"));
  const auto json = nlohmann::json::parse(here(diff + "--json a b").out);
  CHECK(json["verdict"] == "different");
  CHECK(json["first"]["field"] == "particles.velocity");
  CHECK(json["first"]["ulps"] == 2);

  REQUIRE(here(tool + scene + "--trace a --trace-values 100").exit_code == 0);
  const auto without = here(diff + "a b");
  CHECK_THAT(without.out, contains("its values are not in A: run both scenes again with --trace-values 0"));
}

TEST_CASE("traces of several bodies say in which one they part") {
  const TemporaryFolder scratch;
  const auto here = [&](const std::string& command) {
    return run_command("cd " + quoted(scratch.path().string()) + " && " + command);
  };
  const std::string bodies = "--scene " HOMPM_SOURCE_DIR "/docs/scenes/contact.toml --cells 4 ";
  REQUIRE(here(tool + bodies + "--trace a").exit_code == 0);
  REQUIRE(here(tool + bodies + "--set body[1].material.density=1.0000000000000002 --trace b").exit_code == 0);
  const auto other = here(diff + "a b");
  CHECK(other.exit_code == 3);
  CHECK_THAT(other.out,
             contains("first difference: step 0, the state with which the traces begin, total_mass "
                      "of body 1\n"));
  const auto json = nlohmann::json::parse(here(diff + "--json a b").out);
  CHECK(json["first"]["body"] == 1);
  CHECK(json["first"]["field"] == "total_mass");
}

TEST_CASE("what cannot be traced or compared: exit 2 or 5 and the reason") {
  const TemporaryFolder scratch;
  write_file(scratch / "text", "time,particle\n");
  struct Refused {
    std::string command, message;
    int exit_code;
  };
  for (const auto& [command, message, exit_code] :
       {Refused{tool + scene + "--trace no/folder/file", "cannot write no/folder/file: No such file", 5},
        Refused{tool + scene + "--trace /dev/full", "cannot write /dev/full: No space left", 5},
        Refused{tool + scene + "--trace-values 5", "--trace-values goes with --trace", 2},
        Refused{tool + scene + "--trace t --trace-values -1", "--trace-values -1: expected a number of steps",
                2},
        Refused{diff + "text text", "cannot read text: it is not a trace of hompm-run --trace", 5},
        Refused{diff + "none text", "cannot read none: No such file", 5},
        Refused{diff + ". text", "cannot read .: it is a folder", 5},
        Refused{diff + "--ulps all=1 text text", "--trace compares bits: it takes no --ulps", 2},
        Refused{diff + "text", "cannot read text: it is not a trace of hompm-run --trace", 5},
        Refused{diff + "--ulps all=1 text", "--trace of one file prints it: it takes no --ulps", 2},
        Refused{diff + "a b c", "A and B to compare are needed, not 3", 2}}) {
    const auto done = run_command("cd " + quoted(scratch.path().string()) + " && " + command);
    INFO(command << " -> " << done.err);
    CHECK(done.exit_code == exit_code);
    CHECK_THAT(done.err, contains(message));
    CHECK_FALSE(fs::exists(scratch / "out"));
  }
}

TEST_CASE("of an invalid run the reason is told, also where its trace cannot be written", "[trace]") {
  const TemporaryFolder scratch;
  const auto done = run_command(
      "cd " + quoted(scratch.path().string()) + " && " + quoted(HOMPM_BIN_DIR "/hompm-run") +
      " --case bar --variant large --set scheme.allow_unstable=true --time-step 0.5 --trace /dev/full");
  INFO(done.err);
  CHECK(done.exit_code == 4);
  CHECK_THAT(done.err, contains("invalid at step "));
}

TEST_CASE("what a law adds to the results is in the pictures, too", "[run]") {
  const TemporaryFolder scratch;
  const auto done =
      run_command("cd " + quoted(scratch.path().string()) + " && " + quoted(HOMPM_BIN_DIR "/hompm-run") +
                  " --scene " + quoted(HOMPM_SOURCE_DIR "/docs/scenes/plasticity.toml") +
                  " --end-time 0.001 --snapshots 1 --errors none --quiet --output out");
  INFO(done.err);
  REQUIRE(done.exit_code == 0);
  CHECK_THAT(read_file(scratch / "out/vtk/snapshot_0001.vtu"), contains("Name=\"plastic_strain\""));
}
