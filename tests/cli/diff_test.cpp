#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <hompm/number.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/run_command.hpp"
#include "support/sample_run.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using namespace hompm::test;

namespace {

/// Two equal runs; `a` is for damaging.
struct Runs {
  TemporaryFolder folder;
  fs::path a = folder / "a b";  // a blank: the shell and the tool must not mind
  fs::path b = folder / "b";

  Runs() {
    write_sample_run(a, 3);
    write_sample_run(b, 3);
  }
  void replace(const std::string& file, const std::string& from, const std::string& to) const {
    auto text = read_file(a / file);
    REQUIRE(contains(text, from));
    write_file(a / file, text.replace(text.find(from), from.size(), to));
  }
  [[nodiscard]] CommandResult diff(const std::string& options = "", const std::string& behind = "") const {
    return run(options + " " + quoted(a.string()) + " " + quoted(b.string()) + " " + behind);
  }
  static CommandResult run(const std::string& arguments) {
    return run_command("timeout 60 " + quoted(HOMPM_BIN_DIR "/hompm-diff") + " " + arguments);
  }
};

/// Makes the velocity of particle 1 at time 0.1 differ by one ulp.
void spoil_velocity(const Runs& runs) {
  const double velocity = sample_snapshot(0.1, 3).velocity[1];
  const double next = std::nextafter(velocity, 1e300);
  runs.replace("particles.csv", hompm::to_text(velocity), hompm::to_text(next));
}

}  // namespace

TEST_CASE("hompm-diff says identical and nothing else", "[diff]") {
  const Runs runs;
  const auto result = runs.diff();
  CHECK(result.exit_code == 0);
  CHECK(result.out == "identical\n");
  CHECK(result.err.empty());
}

TEST_CASE("hompm-diff tells the first difference and the worst of each field", "[diff]") {
  const Runs runs;
  spoil_velocity(runs);
  runs.replace("stress.csv", "\n0.25,2,", "\n0.25,3,");
  const auto result = runs.diff();
  INFO(result.out);
  CHECK(result.exit_code == 3);
  CHECK(result.err.empty());
  const double velocity = sample_snapshot(0.1, 3).velocity[1];
  const double next = std::nextafter(velocity, 1e300);
  CHECK(
      result.out ==
      "different\nfirst difference: particles.csv, velocity, time 0.1, particle 1: " + hompm::to_text(next) +
          " in A, " + hompm::to_text(velocity) + " in B, 1 ulp\n" + (runs.a / "stress.csv").string() +
          " line 10: row order differs: particle 3 where 2 is expected\n"
          "file           field     values  differing  beyond            worst |A-B|  ulps  time  particle\n"
          "particles.csv  velocity       9          1       1  " +
          hompm::to_text(next - velocity) + "     1   0.1         1\n");
}

TEST_CASE("hompm-diff accepts what a tolerance covers", "[diff]") {
  const Runs runs;
  spoil_velocity(runs);
  for (const std::string options :
       {"--ulps velocity=1", "--ulps=all=1", "--absolute velocity=1e-12", "--relative all=1e-12",
        "--ulps all=0 --ulps velocity=1", "--ulps velocity=1 --ulps stress=0",
        "--ulps stress=9 --absolute all=1"}) {
    INFO(options);
    const auto result = runs.diff(options);
    CHECK(result.exit_code == 0);
    CHECK(result.out.starts_with("equivalent\nfirst difference: particles.csv, velocity"));
  }
  for (const std::string options : {"--ulps stress=1", "--ulps all=0", "--absolute velocity=1e-30",
                                    "--ulps all=1 --ulps velocity=0", "--relative velocity=0"}) {
    INFO(options);
    CHECK(runs.diff(options).exit_code == 3);
  }
}

TEST_CASE("hompm-diff compares the scenes as well", "[diff]") {
  const Runs runs;
  runs.replace("scene.toml", "64", "65");
  const auto result = runs.diff("--absolute all=1e300");
  CHECK(result.exit_code == 3);
  CHECK(result.out == "different\nscene.toml differs at line 2: `cells = 65` against `cells = 64`\n");
}

TEST_CASE("hompm-diff --json prints one object", "[diff]") {
  const Runs runs;
  auto object = nlohmann::json::parse(runs.diff("--json").out);
  CHECK(object["verdict"] == "identical");
  CHECK(object["first"].is_null());
  CHECK(object["messages"].empty());
  CHECK(object["fields"].size() == 21);

  spoil_velocity(runs);
  runs.replace("history.csv", "\n0.25,", "\n0.25,nan");
  const auto result = runs.diff("--json");
  CHECK(result.exit_code == 3);
  object = nlohmann::json::parse(result.out);
  CHECK(object["verdict"] == "different");
  CHECK(object["a"] == runs.a.string());
  CHECK(object["messages"].size() == 1);
  const auto& first = object["first"];
  CHECK(first["file"] == "particles.csv");
  CHECK(first["field"] == "velocity");
  CHECK(first["time"] == 0.1);
  CHECK(first["particle"] == 1);
  CHECK(first["ulps"] == 1);
  CHECK(first["b"].get<double>() == sample_snapshot(0.1, 3).velocity[1]);
  CHECK(object["fields"][3]["differing"] == 1);
  CHECK(object["fields"][3]["worst"] == first);
  CHECK(object["fields"][2]["worst"].is_null());
}

TEST_CASE("hompm-diff --quiet leaves all to the exit code", "[diff]") {
  const Runs runs;
  CHECK(runs.diff("--quiet").exit_code == 0);
  spoil_velocity(runs);
  const auto result = runs.diff("--quiet");
  CHECK(result.exit_code == 3);
  CHECK(result.out.empty());
  CHECK(result.err.empty());
}

TEST_CASE("hompm-diff explains itself", "[diff]") {
  const auto help = Runs::run("--help");
  CHECK(help.exit_code == 0);
  CHECK(help.err.empty());
  for (const std::string word :
       {"usage:", "--absolute", "--relative", "--ulps", "--json", "--quiet", "Exit codes"}) {
    CHECK(contains(help.out, word));
  }
  const auto version = Runs::run("--version");
  CHECK(version.exit_code == 0);
  CHECK(version.out.starts_with("hompm-diff "));
  const auto nothing = Runs::run("");
  CHECK(nothing.exit_code == 2);
  CHECK(nothing.out.empty());
  CHECK(help.out.starts_with(nothing.err));
}

TEST_CASE("hompm-diff refuses a command line it does not understand", "[diff]") {
  const Runs runs;
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"--abs all=1", "unknown option --abs"},  // an abbreviation
      {"--absolut all=1", "did you mean --absolute?"},
      {"-q", "unknown option -q"},
      {"--other=1", "unknown option --other"},
      {"--ulps strss=1", "--ulps strss=1: no field is called strss; did you mean stress?"},
      {"--ulps time=1", "no field is called time"},
      {"--ulps stress", "--ulps stress: expected FIELD=BOUND"},
      {"--ulps stress=", "`` is not a whole number of at least 0"},
      {"--ulps stress=-3", "`-3` is not a whole number of at least 0"},
      {"--ulps stress=1.5", "`1.5` is not a whole number"},
      {"--ulps stress=99999999999999999999", "is not a whole number"},
      {"--absolute stress=nan", "`nan` is not a finite number"},
      {"--absolute stress=inf", "`inf` is not a finite number"},
      {"--relative stress=1e-3x", "`1e-3x` is not a finite number"},
      {"--relative stress=1,5", "`1,5` is not a finite number"},
      {"--relative stress=-1e-3", "cannot be negative"},
      {"--ulps --json", "the value of --ulps is missing: --json is an option"},
      {"--quiet --json", "contradict"},
      {"--json=yes", "--json"},
      {"third", "A and B to compare are needed, not 3"},
  };
  for (const auto& [options, message] : wrong) {
    const auto result = runs.diff(options);
    INFO(options << ": " << result.err);
    CHECK(result.exit_code == 2);
    CHECK(result.out.empty());
    CHECK(result.err.starts_with("hompm-diff: "));
    CHECK(contains(result.err, message));
    CHECK(result.err.find('\n') == result.err.size() - 1);
  }
  CHECK(Runs::run(quoted(runs.a.string())).exit_code == 2);
  CHECK(Runs::run("--ulps").exit_code == 2);
}

TEST_CASE("hompm-diff says what it cannot read or write", "[diff]") {
  const Runs runs;
  const auto check = [](const CommandResult& result, const std::string& message) {
    INFO(result.err);
    CHECK(result.exit_code == 5);
    CHECK(result.out.empty());
    CHECK(result.err == "hompm-diff: " + message + "\n");
  };
  const std::string missing = (runs.folder / "missing").string();
  check(Runs::run(quoted(runs.a.string()) + " " + quoted(missing)),
        "cannot read " + missing + ": No such file or directory");
  check(runs.diff("", ">/dev/full"), "cannot write standard output: No space left on device");

  const auto file = runs.a / "particles.csv";
  fs::remove(file);
  REQUIRE(run_command("mkfifo " + quoted(file.string())).exit_code == 0);
  check(runs.diff(), "cannot read " + file.string() + ": not a regular file");
  fs::remove(file);
  write_file(file, std::string(100000, 'x'));
  check(runs.diff(), "cannot read " + file.string() + ": line 1 is longer than 65536 characters");
}
