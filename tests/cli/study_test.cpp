// hompm-study as its users meet it: the same bytes however it is run, interruption, advice, and bad input.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "support/catch.hpp"
#include "support/run_command.hpp"

using hompm::test::contains;
using hompm::test::quoted;
using hompm::test::read_file;
using hompm::test::run_command;
using hompm::test::TemporaryFolder;
using hompm::test::write_file;
namespace fs = std::filesystem;

namespace {

const std::string tool = HOMPM_BIN_DIR "/hompm-study";
const std::string run_tool = HOMPM_BIN_DIR "/hompm-run";
/// Six points of a few milliseconds, two of which fail.
const std::string tiny =
    tool +
    " --case bar --vary scheme=classical,tielen2017,high-order --vary courant=0.2,2 --set cells=8 --set "
    "end_time=0.5 --repeats 0";
/// The files that do not depend on the clock.
const std::vector<std::string> steady{"points.csv", "study.json", "study.toml", "answers.txt"};

bool has_valgrind() {
#ifdef __SANITIZE_ADDRESS__
  return false;
#else
  return run_command("valgrind --version").exit_code == 0;
#endif
}

void check_same(const fs::path& a, const fs::path& b) {
  for (const auto& name : steady) {
    INFO(name);
    CHECK(read_file(a / name) == read_file(b / name));
  }
}

std::uint64_t instructions_of(const fs::path& folder, const std::string& point) {
  const auto record = nlohmann::json::parse(read_file(folder / "points" / (point + ".json")));
  return record.at("instructions").at("total");
}

}  // namespace

TEST_CASE("a study gives the same bytes with one worker, with two, and in parts") {
  const TemporaryFolder folder;
  const std::string one = folder / "one";
  const std::string two = folder / "two";
  const std::string parts = folder / "parts";
  const auto done = run_command(tiny + " --jobs 1 --output " + quoted(one));
  INFO(done.err);
  REQUIRE(done.exit_code == 0);
  CHECK_THAT(done.out, contains("error 0.1 in displacement: cheapest is `"));
  CHECK_THAT(done.out, contains(" of 6 points: refused: "));
  REQUIRE(run_command(tiny + " --jobs 2 --quiet --output " + quoted(two)).exit_code == 0);
  check_same(one, two);

  const std::string part = tiny + " --output " + quoted(parts);
  std::istringstream names(run_command(part + " --list").out);
  std::vector<std::string> points;
  for (std::string name; std::getline(names, name);) points.push_back(name);
  CHECK(points.size() == 6);
  CHECK_THAT(run_command(part + " --gather").err, contains("6 of 6 points have no current record"));
  for (auto name = points.crbegin(); name != points.crend(); ++name)
    REQUIRE(run_command(part + " --point " + quoted(*name)).exit_code == 0);
  REQUIRE(run_command(part + " --gather").exit_code == 0);
  for (const auto& name : steady)
    if (name != "study.toml") CHECK(read_file(fs::path(one) / name) == read_file(fs::path(parts) / name));
  // Nothing else was left behind.
  for (const auto& entry : fs::directory_iterator(one)) CHECK(entry.path().filename().string()[0] != '.');
}

TEST_CASE("an interrupted study goes on and gives the same bytes") {
  const TemporaryFolder folder;
  const std::string whole = folder / "whole";
  const std::string broken = folder / "broken";
  // About a second; the signal comes when the first record is there. What a script starts in the background
  // ignores it, unless it is told not to.
  const std::string slow =
      tool +
      " --case bar --vary scheme=bspline,tielen2017,high-order --vary courant=0.02,0.01 --set cells=16 "
      "--repeats 0 --jobs 1 --no-instructions --output ";
  const auto stopped = run_command("/usr/bin/env --default-signal=INT " + slow + quoted(broken) +
                                   " & pid=$!; while [ -z \"$(ls " + quoted(broken + "/points") +
                                   " 2>/dev/null)\" ]; do sleep 0.01; done; kill -INT $pid; wait $pid");
  CHECK(stopped.exit_code == 130);
  CHECK_THAT(stopped.err, contains("of 6 points run; the same command goes on from there"));
  CHECK_FALSE(fs::exists(fs::path(broken) / "points.csv"));
  const auto resumed = run_command(slow + quoted(broken));
  CHECK(resumed.exit_code == 0);
  CHECK_THAT(resumed.out, contains("of 6 are there already"));
  REQUIRE(run_command(slow + quoted(whole)).exit_code == 0);
  check_same(whole, broken);
}

TEST_CASE("a damaged record is run anew, a current one is not") {
  const TemporaryFolder folder;
  const std::string command =
      tool +
      " --case bar --set cells=8 --vary courant=0.2,0.1 --set end_time=0.1 --repeats 0 "
      "--no-instructions --output " +
      quoted(folder / "out");
  REQUIRE(run_command(command).exit_code == 0);
  const fs::path damaged = folder / "out/points/courant=0.1.json";
  const fs::path kept = folder / "out/points/courant=0.2.json";
  const std::string record = read_file(damaged);
  const auto before = fs::last_write_time(kept);
  write_file(damaged, record.substr(0, 100));
  REQUIRE(run_command(command).exit_code == 0);
  CHECK(read_file(damaged) == record);
  CHECK(fs::last_write_time(kept) == before);
}

TEST_CASE("times are taken once per round and kept, and tables and pictures are made of them") {
  const TemporaryFolder folder;
  const std::string command =
      tool +
      " --case bar --set cells=8 --vary scheme=classical,bspline --set end_time=0.5 --set courant=0.2 "
      "--no-instructions --output " +
      quoted(folder / "out");
  const auto done = run_command(command + " --repeats 2");
  REQUIRE(done.exit_code == 0);
  CHECK_THAT(done.out, contains("timing    2 points, one run at a time, up to 2 rounds"));
  CHECK_THAT(done.out, contains("particle steps, "));  // and milliseconds
  CHECK_THAT(read_file(folder / "out/times.csv"), contains("scheme=bspline,2,"));
  REQUIRE(run_command(command + " --repeats 3 --times").exit_code == 0);
  const auto times = nlohmann::json::parse(read_file(folder / "out/times/scheme=bspline.json"));
  CHECK(times.at("seconds").size() == 3);
  if (run_command("gnuplot --version").exit_code != 0) return;
  for (const char* name : {"error-particle-steps.svg", "error-particle-steps.png", "error-seconds.svg"})
    CHECK(fs::file_size(folder / "out" / name) > 1000);
}

TEST_CASE("counted steps stand for the whole run to half a percent") {
  if (!has_valgrind()) {
    WARN("valgrind is not there");
    return;
  }
  const TemporaryFolder folder;
  struct Run {
    std::string scene, scheme, cells, courant;
  };
  // The column's free end passes over cells, so a step costs more and less as it swings. More than 100 steps:
  // the first one is cheaper by half.
  for (const auto& [scene, scheme, cells, courant] :
       {Run{"bar", "high-order", "8", "0.1"}, Run{"bar", "bspline", "16", "0.1"},
        Run{"column", "tielen2017", "8", "0.4"}, Run{"column", "high-order", "8", "0.2"}}) {
    INFO(scene << " " << scheme);
    REQUIRE(run_command(tool + " --case " + scene + " --set scheme=" + scheme + " --set cells=" + cells +
                        " --vary courant=" + courant + " --repeats 0 --quiet --output " +
                        quoted(folder / "out"))
                .exit_code == 0);
    const auto whole = run_command(
        "valgrind --tool=callgrind --callgrind-out-file=/dev/null --collect-atstart=no "
        "'--toggle-collect=hompm::Simulation::step(double)' " +
        run_tool + " --case " + scene + " --scheme " + scheme + " --cells " + cells + " --courant " +
        courant + " --no-vtk --quiet --output " + quoted(folder / "run"));
    REQUIRE(whole.exit_code == 0);
    const auto label = whole.err.find("Collected : ");
    REQUIRE(label != whole.err.npos);
    const double exact = std::stod(whole.err.substr(label + 12));
    const auto counted = static_cast<double>(instructions_of(folder / "out", "courant=" + courant));
    INFO(counted << " " << exact);
    CHECK(std::abs(counted / exact - 1.0) < 0.005);
  }
}

TEST_CASE("instructions repeat to the digit") {
  if (!has_valgrind()) return;
  const TemporaryFolder folder;
  const std::string point = "scheme=high-order,degree=4";
  std::vector<std::uint64_t> counts;
  for (const char* name : {"a", "a longer name than before"}) {
    const std::string out = folder / name;
    REQUIRE(run_command(tool +
                        " --case bar --set cells=8 --set courant=0.1 --vary scheme=high-order --vary "
                        "degree=4 --repeats 0 "
                        "--quiet --output " +
                        quoted(out))
                .exit_code == 0);
    counts.push_back(instructions_of(out, point));
  }
  CHECK(counts[0] == counts[1]);
}

TEST_CASE("advice names the setting, and the command that runs it") {
  const TemporaryFolder folder;
  const std::string command =
      tiny + " --no-instructions --output " + quoted(folder / "out") + " --advise --error ";
  const auto advice = run_command(command + "0.05 --field stress");
  CHECK(advice.exit_code == 0);
  CHECK_THAT(advice.out, contains("error 5e-2 in stress: cheapest is `"));
  const auto at = advice.out.find("\nhompm-run ");
  REQUIRE(at != advice.out.npos);
  const std::string best =
      HOMPM_BIN_DIR "/" + advice.out.substr(at + 1, advice.out.find('\n', at + 1) - at - 1);
  CHECK(run_command(best + " --no-vtk --quiet --output " + quoted(folder / "run")).exit_code == 0);
  const auto none = run_command(command + "1e-14");
  CHECK(none.exit_code == 4);
  CHECK_THAT(none.out, contains("nothing gets there; the best is "));
}

TEST_CASE("hompm-study says what is wrong with its options, and runs nothing") {
  const TemporaryFolder folder;
  const auto complaint = [&](const std::string& options) {
    const auto done = run_command("cd " + quoted(folder.path().string()) + " && " + tool + " " + options);
    CHECK(done.exit_code == 2);
    CHECK(std::count(done.err.begin(), done.err.end(), '\n') == 1);
    return done.err;
  };
  CHECK_THAT(complaint("--case bar --vry cells"), contains("unknown option --vry; did you mean --vary?"));
  CHECK_THAT(complaint("--case bra"), contains("did you mean bar?"));
  CHECK_THAT(complaint("--case bar --vary cels=8"), contains("did you mean `cells`?"));
  CHECK_THAT(complaint("--case bar --vary scheme=bspine"), contains("did you mean \"bspline\"?"));
  CHECK_THAT(complaint("--case bar --vary cells --vary cells=8"), contains("--vary names cells twice"));
  CHECK_THAT(complaint("--case bar --variant small --set scheme.cells=8 --vary cells=4,8"),
             contains("--set scheme.cells=8: cells is varied"));
  CHECK_THAT(complaint("--case bar --variant small --set end_time=0 --vary cells=4"),
             contains("--set end_time=0: `end_time` must be"));
  CHECK_THAT(complaint("--case bar --variant small --vary cells=4,-8"),
             contains("--vary cells=4,-8: `scheme.cells` must be"));
  write_file(folder / "wrong.toml", "case = \"bar\"\n[set]\nend_time = 0\n[[sweep]]\ncells = 4\n");
  CHECK_THAT(complaint("--study wrong.toml"), contains("wrong.toml:3:12: `end_time` must be"));
  fs::remove(folder / "wrong.toml");
  CHECK_THAT(complaint("--case bar --set cells"), contains("expected KEY=VALUE"));
  CHECK_THAT(complaint("--jobs 2"), contains("nothing to study"));
  CHECK_THAT(complaint("--case bar --study x.toml"), contains("exclude each other"));
  CHECK_THAT(complaint("--study x.toml --variant large"), contains("--variant goes with --case"));
  CHECK_THAT(complaint("--case bar --jobs 0"), contains("from 1 to 1024"));
  CHECK_THAT(complaint("--case bar --repeats 1001"), contains("at most 1000"));
  CHECK_THAT(complaint("--case bar --error 1"), contains("--error goes with --advise"));
  CHECK_THAT(complaint("--case bar --advise"), contains("--advise needs --error"));
  CHECK_THAT(complaint("--case bar --advise --error -1"), contains("greater than 0"));
  CHECK_THAT(complaint("--case bar --field stres"), contains("did you mean stress?"));
  CHECK_THAT(complaint("--case bar --vary cells=8 --point cells=9"), contains("did you mean cells=8?"));
  CHECK_THAT(complaint("--case bar more"), contains("`more` is not an option"));
  CHECK(fs::is_empty(folder.path()));
  CHECK(run_command(tool).exit_code == 2);
  CHECK(run_command(tool + " --help").exit_code == 0);
  CHECK_THAT(run_command(tool + " --version").out, contains("hompm-study "));
}

TEST_CASE("a study that cannot be read or written says so") {
  const TemporaryFolder folder;
  const auto missing = run_command(tool + " --study " + quoted(folder / "none.toml"));
  CHECK(missing.exit_code == 5);
  CHECK_THAT(missing.err, contains("cannot read"));
  // A file size limit stands for a full disk.
  const auto full = run_command("{ (ulimit -f 0; " + tiny + " --no-instructions --output " +
                                quoted(folder / "out") + "); echo exit code $?; } 2>&1 | cat");
  CHECK_THAT(full.out, contains("cannot write"));
  CHECK_THAT(full.out, contains("exit code 5"));
  write_file(folder / "file", "");
  CHECK(run_command(tiny + " --output " + quoted(folder / "file/out")).exit_code == 5);
}

TEST_CASE("without valgrind the axis is left empty, and said so once") {
  const TemporaryFolder folder;
  const auto done = run_command("PATH=/nowhere " + tiny + " --output " + quoted(folder / "out"));
  CHECK(done.exit_code == 0);
  CHECK_THAT(done.err, contains("valgrind is not there, so no instructions are counted"));
  CHECK_THAT(done.err, contains("gnuplot is not there"));
  CHECK_THAT(done.out, contains("particle steps"));
}

TEST_CASE("a scene of several bodies cannot be studied, and every point says so") {
  const TemporaryFolder folder;
  const auto done = run_command(tool +
                                " --scene " HOMPM_SOURCE_DIR
                                "/docs/scenes/contact.toml --vary cells=8,16 "
                                "--repeats 0 --no-instructions --output " +
                                quoted(folder / "out"));
  CHECK_THAT(done.out, contains("2 of 2 points: refused"));
  CHECK_THAT(read_file(folder / "out/points/cells=8.json"),
             contains("a study needs an exact solution, and of several bodies none is known"));
}
