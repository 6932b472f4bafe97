// hompm-exact as its users meet it.
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "support/catch.hpp"
#include "support/run_command.hpp"

using hompm::test::contains;
using hompm::test::quoted;
using hompm::test::read_file;
using hompm::test::run_command;
using hompm::test::TemporaryFolder;
using hompm::test::write_file;

namespace {

const std::string tool = HOMPM_BIN_DIR "/hompm-exact";

std::size_t count_lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_CASE("hompm-exact prints the fields of every point at every time, in the order asked") {
  const auto done = run_command(tool + " --case column --at 1,0,0.5 --times 2.5,0");
  INFO(done.err);
  REQUIRE(done.exit_code == 0);
  CHECK(done.err.empty());
  CHECK(done.out.rfind(
            "time,X,x,displacement,velocity,stress,stretch,density,displacement_error,velocity_error,"
            "stress_error,stretch_error,density_error\n2.5,1,",
            0) == 0);
  CHECK(count_lines(done.out) == 7);
  CHECK_THAT(done.out,
             contains("\n2.5,0,") && contains("\n2.5,0.5,") && contains("\n0,1,1,0,0,0,1,1000,0,0,0,0,0\n"));
  const auto defaults = run_command(tool + " --case column");
  CHECK(count_lines(defaults.out) == 102);
  CHECK_THAT(defaults.out, contains("\n2.5,0.01,"));
  // A closed form has no error but rounding: nothing is said of it.
  const auto closed =
      run_command(tool + " --case bar --variant small --set material.law=linear --at 0:25:3 --times 0.5");
  CHECK_THAT(closed.out, contains("\n0.5,12.5,") && contains(",,,,,\n"));
}

TEST_CASE("hompm-exact tells jumps and kinks") {
  const TemporaryFolder scratch;
  write_file(scratch / "pull.toml", R"(end_time = 1.0
body = { length = 1.0 }
material = { law = "linear", density = 1000.0, youngs_modulus = 1e5 }
ends = { left = "fixed", right = "free" }
effect = [{ type = "traction", value = 500.0 }]
scheme = { cells = 8, particles_per_cell = 2, step_fraction = 0.1 }
)");
  const std::string scene = tool + " --scene " + quoted(scratch / "pull.toml") + " --times 0.05";
  const auto table = run_command(scene + " --jumps");
  INFO(table.out << table.err);
  REQUIRE(table.exit_code == 0);
  CHECK(table.out.rfind("time,X,field,kind,left,right\n0.05,0.5,displacement,kink,", 0) == 0);
  CHECK_THAT(table.out, contains("\n0.05,0.5,velocity,jump,") && contains("\n0.05,0.5,stress,jump,"));
  const auto json = nlohmann::json::parse(run_command(scene + " --at 0.25,0.75 --json").out);
  CHECK(json["closed_form"] == true);
  CHECK(json["displacement_error"].is_null());
  CHECK(json["stress"].size() == 2);
  CHECK(json["jumps"].size() == 3);
  CHECK(json["jumps"][2]["kind"] == "jump");
  const auto unknown = run_command(tool + " --case bar --times 0.5 --jumps");
  CHECK(unknown.exit_code == 2);
  CHECK_THAT(unknown.err, contains("it is not known where this solution jumps: method of lines"));
  const auto lines = nlohmann::json::parse(run_command(tool + " --case bar --times 0.5 --at 1 --json").out);
  CHECK(lines["jumps"].is_null());
  CHECK(lines["closed_form"] == false);
  CHECK(lines["stress_error"].size() == 1);
}

TEST_CASE("hompm-exact reads points from a table, and writes whole files") {
  const TemporaryFolder scratch;
  write_file(scratch / "points.csv", "mass,X,time\n1,0.5,0.2\n1,0.25,0.1\n");
  const std::string command = tool + " --case column --points " + quoted(scratch / "points.csv");
  const auto done = run_command(command);
  INFO(done.err);
  REQUIRE(done.exit_code == 0);
  CHECK_THAT(done.out, contains("\n0.2,0.5,") && contains("\n0.1,0.25,"));
  CHECK(done.out.find("\n0.2,0.5,") < done.out.find("\n0.1,0.25,"));
  const std::string out = quoted(scratch / "deep/exact.csv");
  REQUIRE(run_command(command + " --output " + out).exit_code == 0);
  CHECK(read_file(scratch / "deep/exact.csv") == done.out);
  REQUIRE(run_command(command + " --output /dev/null").exit_code == 0);
  CHECK(std::filesystem::is_character_file("/dev/null"));

  CHECK(run_command(command + " >/dev/full").exit_code == 5);
  CHECK(run_command(command + " --output /dev/full").exit_code == 5);
  const auto full = run_command("trap '' XFSZ; ulimit -f 1; " + tool + " --case column --output " +
                                quoted(scratch / "full.csv"));
  CHECK(full.exit_code == 5);
  CHECK_FALSE(std::filesystem::exists(scratch / "full.csv"));
  CHECK(run_command(tool + " --case column --points " + quoted(scratch / "none.csv")).exit_code == 5);
}

TEST_CASE("hompm-exact refuses what makes no sense in one line") {
  const TemporaryFolder scratch;
  write_file(scratch / "far.csv", "time,X\n0.1,0.5\n0.1,1.5\n");
  write_file(scratch / "bad.csv", "time,X\n0.1,half\n");
  write_file(scratch / "place.csv", "time,place\n0.1,0.5\n");
  write_file(scratch / "empty.csv", "time,X\n");
  struct Refused {
    std::string arguments, message;
  };
  const auto bad = GENERATE(values<Refused>({
      {"--at 0", "nothing to run"},
      {"--case column --at 0:1", "there are 2 parts; expected FROM:TO:HOW-MANY or a list"},
      {"--case column --at 0:1:1", "it must be 2 to 2000000 numbers"},
      {"--case column --at 0:1:x", "`x` is not a whole number"},
      {"--case column --at -1e308:1e308:3", "it must be 2 to"},
      {"--case column --at nan", "`nan` is not a finite number"},
      {"--case column --at 0,,1", "`` is not a finite number"},
      {"--case column --at 0:1:11 --times 3", "--times 3: t = 3 s is not within the run, 0 to 2.5 s"},
      {"--case column --times -1:1:3", "t = -1 s is not within"},
      {"--case column --at 0:1.5:4", "X = 1.5 m is not in the body, 0 to 1 m"},
      {"--case column --at 0:1:2000000 --times 0:1:2", "more than 2000000 points"},
      {"--case column --points far.csv", "far.csv:3:1: X = 1.5 m is not in the body"},
      {"--case column --points bad.csv", "bad.csv line 2"},
      {"--case column --points empty.csv", "empty.csv: it has no points"},
      {"--case column --points far.csv --at 0", "--points takes no --at"},
      {"--case column --times 2 --set effect.gravity.acceleration=-90", "no exact solution at t = 2 s"},
      {"--case column --tims 2", "did you mean --times?"},
      {"--case colum", "column"},
      {"--scene none.toml --case bar", "exclude"},
      {"--case column --variant settled --times 0.1", "is its state of rest"},
  }));
  const auto done =
      run_command("cd " + quoted(scratch.path().string()) + " && " + tool + " " + bad.arguments);
  INFO(bad.arguments << " -> " << done.err);
  CHECK(done.exit_code == 2);
  CHECK(done.out.empty());
  CHECK_THAT(done.err, contains(bad.message));
  CHECK(count_lines(done.err) == 1);
  CHECK(done.err.rfind("hompm-exact: ", 0) == 0);
  const auto place = run_command(tool + " --case column --points " + quoted(scratch / "place.csv"));
  CHECK(place.exit_code == 5);
  CHECK_THAT(place.err, contains("it has no column X"));
}
