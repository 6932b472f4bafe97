#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <hompm/number.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/run_command.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using namespace hompm::test;

namespace {

const std::string golden = HOMPM_SOURCE_DIR "/golden/bar-small-bspline";

/// Golden particles with one velocity off by 1e-3 m/s, which is 1 % of the largest.
struct Csv {
  TemporaryFolder folder;
  fs::path path = folder / "their results.csv";

  Csv() {
    auto text = read_file(golden + "/particles.csv");
    const std::string velocity = "0.0006135884649154476";
    REQUIRE(contains(text, velocity));
    write_file(path, text.replace(text.find(velocity), velocity.size(), "0.0016135884649154476"));
  }
  [[nodiscard]] CommandResult diff(const std::string& options = "",
                                   const std::string& environment = "") const {
    return run_command(environment + " timeout 60 " + quoted(HOMPM_BIN_DIR "/hompm-diff") + " " + options +
                       " " + quoted(path.string()) + " " + quoted(golden));
  }
  [[nodiscard]] std::string picture(const std::string& name) const {
    return quoted((folder / name).string());
  }
};

}  // namespace

TEST_CASE("hompm-diff holds a CSV file against golden and exact solution", "[foreign]") {
  const Csv csv;
  auto result = csv.diff();
  INFO(result.out << result.err);
  CHECK(result.exit_code == 3);
  CHECK(result.err.empty());
  CHECK(result.out.starts_with(
      "different\ncompared: x, displacement, velocity, volume, density; not compared, not "
      "being in A: stress, stretch\nerrors over the largest value of the field in B\nfield "));
  CHECK(contains(result.out, "\nvelocity          0.1     0        256          1       1  0.0488     0.01"));
  CHECK(contains(result.out, "     <-\n"));
  CHECK(result.out.ends_with(
      "\ndisplacement agrees in every bit, velocity to 2.0 digits, volume in every bit, density in "
      "every bit (worst at X = 0.0488 m, t = 0 s)\n"));
  CHECK(contains(result.out, "\nexact: method of lines"));
  result = csv.diff("--relative velocity=0.0101");
  CHECK(result.exit_code == 0);
  CHECK(result.out.starts_with("equivalent\n"));
  CHECK(csv.diff("--absolute velocity=0.9999e-3").exit_code == 3);
  CHECK(csv.diff("--absolute velocity=1.0001e-3 --quiet").exit_code == 0);
  CHECK(csv.diff("--exact velocity=0.0101").exit_code == 0);
  result = csv.diff("--exact velocity=0.0099");
  CHECK(result.exit_code == 3);
  CHECK(contains(result.out, "0.01!"));
  CHECK(contains(result.out, "\n!: further from the exact solution than --exact allows\n"));
  CHECK(csv.diff("--time 1.25").exit_code == 0);
}

TEST_CASE("hompm-diff --json tells all figures of a CSV file", "[foreign]") {
  const Csv csv;
  const auto result = csv.diff("--json --relative all=1e-3 --time 0 --time 2.5");
  CHECK(result.exit_code == 3);
  const auto object = nlohmann::json::parse(result.out);
  CHECK(object["verdict"] == "different");
  CHECK(object["a"] == csv.path.string());
  CHECK(object["b"] == golden);
  CHECK(object["messages"].empty());
  CHECK(object["reference_error"].get<double>() < 1e-6);
  CHECK(object["fields"].size() == 5 * 2);
  const auto velocity = *std::find_if(object["fields"].begin(), object["fields"].end(),
                                      [](const auto& field) { return field["field"] == "velocity"; });
  CHECK(velocity["time"] == 0.0);
  CHECK(velocity["particles"] == 256);
  CHECK(velocity["beyond"] == 1);
  CHECK(velocity["worst_X"] == 0.048828125);
  CHECK(std::abs(velocity["difference"]["max"].get<double>() - 1e-3) < 1e-15);
  CHECK(std::abs(velocity["difference"]["rms"].get<double>() - 1e-3 / 16.0) < 1e-15);  // one of 256
  CHECK(velocity["golden_error"]["max"].get<double>() < 1e-15);
  CHECK(object["fields"][0]["error"].is_null());
}

TEST_CASE("hompm-diff draws pictures through gnuplot", "[foreign]") {
  const Csv csv;
  auto result = csv.diff("--quiet --relative all=1 --picture " + csv.picture("a b.svg"));
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK(result.err.empty());
  const auto svg = read_file(csv.folder / "a b.svg");
  CHECK(contains(svg, "</svg>"));
  for (const std::string word :
       {">displacement, t = 1.25 s<", ">velocity, t = 2.5 s<", ">exact<", ">|A-exact|<"}) {
    CHECK(contains(svg, word));
  }
  CHECK(csv.diff("--quiet --picture " + csv.picture("a.png")).exit_code == 3);
  CHECK(read_file(csv.folder / "a.png").starts_with("\x89PNG"));

  SECTION("without gnuplot all but the picture works") {
    result = run_command("/usr/bin/env PATH=/nowhere " + quoted(HOMPM_BIN_DIR "/hompm-diff") +
                         " --relative all=1 --picture " + csv.picture("b.svg") + " " +
                         quoted(csv.path.string()) + " " + quoted(golden));
    CHECK(result.exit_code == 0);
    CHECK(result.out.starts_with("equivalent\n"));
    CHECK(result.err ==
          "hompm-diff: no picture: gnuplot is not installed (Debian package gnuplot-nox); its script is " +
              (csv.folder / "b.gnuplot").string() + "\n");
    CHECK_FALSE(fs::exists(csv.folder / "b.svg"));
  }
  SECTION("gnuplot that fails is told") {
    write_file(csv.folder / "bin/gnuplot", "#!/bin/sh\necho it is broken >&2\nexit 1\n");
    fs::permissions(csv.folder / "bin/gnuplot", fs::perms::owner_all);
    result = csv.diff("--picture " + csv.picture("b.svg"),
                      "PATH=" + quoted((csv.folder / "bin").string()) + ":$PATH");
    CHECK(result.exit_code == 5);
    CHECK(result.err == "hompm-diff: gnuplot failed: it is broken \n");
    CHECK_FALSE(fs::exists(csv.folder / "b.svg"));
  }
  SECTION("a folder that cannot be written is told") {
    result = csv.diff("--picture /proc/b.svg");
    CHECK(result.exit_code == 5);
    CHECK(contains(result.err, "hompm-diff: cannot write in /proc"));
  }
  SECTION("nothing to draw is told") {
    write_file(csv.path, "time,X,density\n0,0.048828125,1\n");
    result = csv.diff("--time 0 --picture " + csv.picture("b.svg"));
    CHECK(result.err == "hompm-diff: no picture: there is no displacement, velocity or stress to draw\n");
  }
}

TEST_CASE("hompm-diff refuses options that make no sense with what is compared", "[foreign]") {
  const Csv csv;
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"--exact stretch=1", "no field is called stretch"},
      {"--exact velocty=1", "did you mean velocity?"},
      {"--exact velocity=-1", "a bound cannot be negative"},
      {"--relative kinetic=1", "no field is called kinetic"},
      {"--time now", "--time now: `now` is not a finite number"},
      {"--time 3", "--time 3: B has only the times 0, 1.25, 2.5"},
      {"--picture a.eps", "the name must end in .svg, .png or .pdf"},
      {"--picture --time 0", "the value of --picture is missing"},
      {"--interpolate=yes", "--interpolate"},
      {"--fields displacment", "no field is called displacment; did you mean displacement?"},
      {"--column velocity", "expected FIELD=BOUND"},
      {"--direction q", "it is x, y or z"},
      {"--time-tolerance -1", "a bound cannot be negative"},
  };
  const auto check = [](const CommandResult& result, const std::string& message) {
    INFO(message << ": " << result.err);
    CHECK(result.exit_code == 2);
    CHECK(result.out.empty());
    CHECK(result.err.starts_with("hompm-diff: "));
    CHECK(contains(result.err, message));
    CHECK(result.err.find('\n') == result.err.size() - 1);
  };
  for (const auto& [options, message] : wrong) check(csv.diff(options), message);
  for (const std::string option : {"--exact all=1", "--time 0", "--interpolate", "--picture a.svg"}) {
    const auto result =
        run_command(quoted(HOMPM_BIN_DIR "/hompm-diff") + " " + option + " " + golden + " " + golden);
    check(result, "goes with a file of another code in the place of A, which is a folder");
  }
}

TEST_CASE("hompm-diff --which says of what it can tell nothing, and why", "[foreign]") {
  const TemporaryFolder folder;
  const auto which = [&](const std::string& a, const std::string& b) {
    return run_command("cd " + quoted(folder.path().string()) + " && timeout 60 " +
                       quoted(HOMPM_BIN_DIR "/hompm-diff") + " --which " + a + " " + b);
  };
  const std::string settled = HOMPM_SOURCE_DIR "/golden/column-settled-bspline";
  CHECK(contains(which(settled + "/particles.csv", settled).err, "the scene runs to rest"));

  // Nothing at rest in a bar of four cells: of 3 steps of 0.1 s the first ends at a time of A, none of 0.2 s.
  const auto scene = [](const std::string& end_time, const std::string& step) {
    return "end_time = " + end_time +
           "\nbody = { length = 4.0 }\nmaterial = { law = \"linear\", density = 1.0, youngs_modulus = 1.0 }\n"
           "initial.velocity = { shape = \"sine\", amplitude = 0.01 }\n"
           "scheme = { cells = 4, particles_per_cell = 2, allow_unstable = true, time_step = " +
           step + " }\n";
  };
  write_file(folder / "few.toml", scene("0.3", "0.1"));
  write_file(folder / "few.csv", "X,time,displacement\n0.25,0.1,0.01\n");
  const auto few = which("few.csv", "few.toml");
  CHECK(few.exit_code == 0);
  CHECK(contains(few.out, " more are not possible"));
  write_file(folder / "unstable.toml", scene("300.0", "3.0"));
  write_file(folder / "unstable.csv", "X,time,displacement\n0.25,300,0.01\n");
  CHECK(contains(which("unstable.csv", "unstable.toml").out, "as it is: invalid at step "));
}

TEST_CASE("a bound on a field that A does not have fails, whatever the effects of the scene", "[foreign]") {
  const TemporaryFolder folder;
  const std::string column = HOMPM_SOURCE_DIR "/golden/column-small-bspline";
  write_file(folder / "theirs.csv", "X,time,displacement\n0.1,0,0\n");
  const auto result = run_command(quoted(HOMPM_BIN_DIR "/hompm-diff") + " --relative all=1 " +
                                  quoted((folder / "theirs.csv").string()) + " " + quoted(column));
  CHECK(result.exit_code == 3);
  CHECK(contains(result.out, "velocity"));
  CHECK(contains(result.out, "not compared, not being in A: "));
}

TEST_CASE("the locale of the process changes nothing", "[foreign]") {
  const Csv csv;
  // de_DE writes decimal commas. Where its sources are not installed only its name is there, and C is used.
  const std::string made = (csv.folder / "locales").string();
  fs::create_directories(made);
  run_command("localedef -i de_DE -f UTF-8 " + quoted(made + "/de_DE.UTF-8"));
  const std::string german = "LOCPATH=" + quoted(made) + " LC_ALL=de_DE.UTF-8";
  for (const std::string options : {"--relative all=1e-3", "--json", "--exact all=0.001"}) {
    const auto result = csv.diff(options, german);
    CHECK(result.exit_code == 3);
    CHECK(result.out == csv.diff(options).out);
  }
  CHECK(csv.diff("--relative velocity=0,5", german).exit_code == 2);
  const std::string picture = csv.picture("german.svg");
  CHECK(csv.diff("--quiet --picture " + picture, german).exit_code == 3);
  const auto svg = read_file(csv.folder / "german.svg");
  CHECK(contains(svg, "t = 1.25 s"));
  CHECK_FALSE(contains(svg, "0,05"));
}
