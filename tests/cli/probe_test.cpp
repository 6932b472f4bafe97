// What hompm-run tells beside snapshots: probes, first steps; and what becomes of an earlier run.
#include <filesystem>
#include <string>

#include "support/catch.hpp"
#include "support/run_command.hpp"

using hompm::test::contains;
using hompm::test::quoted;
using hompm::test::read_file;
using hompm::test::run_command;
using hompm::test::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

const std::string tool = HOMPM_BIN_DIR "/hompm-run";
const std::string quick = " --case column --cells 8 --end-time 0.05 --no-vtk";

std::size_t count_lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_CASE("hompm-run --probe writes probes.csv, and a run without takes an old one away") {
  const TemporaryFolder scratch;
  const std::string probes = quick + " --probe right --probe 0.5 --probe x=0.25";
  const auto done = run_command(tool + probes + " --output " + quoted(scratch / "whole"));
  INFO(done.err);
  REQUIRE(done.exit_code == 0);
  const std::string whole = read_file(scratch / "whole/probes.csv");
  CHECK(whole.rfind("time,probe,X,x,displacement,velocity,density,stress,stretch\n0,0,1,1,0,0,1000,0,1\n",
                    0) == 0);
  CHECK(count_lines(whole) == 1 + 3 * 101);
  CHECK_THAT(read_file(scratch / "whole/scene.toml"), contains("[[probe]]\nend = \"right\"\n"));

  const std::string folder = quoted(scratch / "whole");
  REQUIRE(run_command(tool + quick + " --output " + folder).exit_code == 0);
  CHECK_FALSE(fs::exists(scratch / "whole/probes.csv"));
  const auto refused = run_command(tool + quick + " --probe 1.5 --output " + quoted(scratch / "none"));
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, contains("--probe 1.5: `X` of a probe must be in a body, 0 to 1 m, not 1.5"));
  CHECK_FALSE(fs::exists(scratch / "none"));
}

TEST_CASE("hompm-run --dump-steps writes every value of the first steps, which change nothing") {
  const TemporaryFolder scratch;
  const std::string out = " --output " + quoted(scratch / "out");
  REQUIRE(run_command(tool + quick + " --scheme classical --output " + quoted(scratch / "plain")).exit_code ==
          0);
  REQUIRE(run_command(tool + quick + " --scheme classical --dump-steps 2" + out).exit_code == 0);
  CHECK(read_file(scratch / "out/particles.csv") == read_file(scratch / "plain/particles.csv"));
  const std::string steps = read_file(scratch / "out/steps.csv");
  CHECK(steps.rfind("step,part,stage,body,field,index,value\n0,0,start,0,step,0,0\n", 0) == 0);
  // 1000 kg/m³ in cells of 1/8 m: half of one at the first function, all of one at the next.
  CHECK_THAT(steps, contains(",grid.mass,0,62.5\n") && contains(",grid.mass,1,125\n"));
  CHECK_THAT(steps, contains("\n2,1,") && !contains("\n3,1,"));
  CHECK_THAT(steps, contains(",particles.velocity,31,-0.0"));
  REQUIRE(run_command(tool + quick + " --scheme high-order --dump-steps 1" + out).exit_code == 0);
  CHECK_THAT(read_file(scratch / "out/steps.csv"), contains(",particles.mass,33,0\n"));

  // A run that becomes invalid keeps them: there they are wanted most.
  const auto invalid = run_command(
      tool + " --case bar --set scheme.allow_unstable=true --time-step 0.07 --end-time 50 --dump-steps 1" +
      out);
  CHECK(invalid.exit_code == 4);
  CHECK(fs::exists(scratch / "out/steps.csv"));
  CHECK_THAT(run_command(tool + quick + " --dump-steps 1 --trace t").err,
             contains("--dump-steps takes no --trace"));
  CHECK(run_command(tool + quick + " --dump-steps 0" + out).exit_code == 2);
}

TEST_CASE("hompm-diff --trace prints one trace") {
  const TemporaryFolder scratch;
  const std::string trace = quoted(scratch / "a.trace");
  REQUIRE(
      run_command(tool + quick + " --output " + quoted(scratch / "out") + " --trace " + trace).exit_code ==
      0);
  const std::string diff = HOMPM_BIN_DIR "/hompm-diff --trace " + trace;
  const auto printed = run_command(diff);
  CHECK(printed.exit_code == 0);
  CHECK(printed.out.rfind("by hompm ", 0) == 0);
  CHECK_THAT(printed.out, contains("from step 0 on\nstep 1\n") && contains("\nstep 2\n"));
  CHECK_THAT(printed.out, contains("gravity") && contains("grid.force") && contains("  0x"));
  CHECK(run_command(diff + " --json").exit_code == 2);
  CHECK(run_command(HOMPM_BIN_DIR "/hompm-diff --trace " + quoted(scratch / "out/run.json")).exit_code == 5);
}

TEST_CASE("the default folder tells the setting, and a run of another scene there is not replaced silently") {
  const TemporaryFolder scratch;
  const std::string here = "cd " + quoted(scratch.path().string()) + " && " + tool + quick;
  REQUIRE(run_command(here).exit_code == 0);
  const fs::path folder = scratch / "hompm-out/column-large-tielen2017-p2-8";
  CHECK(fs::exists(folder / "run.json"));
  CHECK(run_command(here).err.empty());
  CHECK(run_command(here + " --degree 3").err.empty());
  const auto other = run_command(here + " --snapshots 5");
  CHECK_THAT(other.err, contains("hompm-run: warning: the run of another scene in hompm-out/column-large") &&
                            contains("here `snapshots = 5`, there `snapshots = 10`"));
  CHECK(run_command(here + " --quiet").err.empty());
}

TEST_CASE("option --check keeps the snapshots of the case where those of the golden data are among them") {
  const TemporaryFolder scratch;
  const std::string golden = quoted(scratch / "golden");
  REQUIRE(run_command(tool + quick + " --snapshots 2 --set output.history=50 --output " + golden).exit_code ==
          0);
  const std::string check = tool + quick + " --check " + golden + " --output " + quoted(scratch / "out");
  const auto kept = run_command(check);
  INFO(kept.err << kept.out);
  CHECK(kept.exit_code == 0);
  CHECK_THAT(kept.out, contains("identical"));
  CHECK_THAT(read_file(scratch / "out/scene.toml"), contains("snapshots = 10\nhistory = 100\n"));
  CHECK(run_command(check + " --probe 0.5").exit_code == 0);
  CHECK(run_command(check + " --snapshots 3").exit_code == 2);
  CHECK(run_command(check + " --set scheme.cells=16").exit_code == 2);
}
