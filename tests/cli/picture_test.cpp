// Pictures of runs by hompm-run, as its users meet them.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/run_command.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using namespace hompm::test;

namespace {

const std::string tool = quoted(HOMPM_BIN_DIR "/hompm-run");
const std::string without_gnuplot = "PATH=/nowhere ";
const std::string small = " --case column --cells 8 --end-time 0.2 --quiet ";

/// A folder with the small column by some schemes, and commands in it.
struct Runs {
  TemporaryFolder folder;

  [[nodiscard]] CommandResult operator()(const std::string& arguments, const std::string& before = "") const {
    return run_command("cd " + quoted(folder.path().string()) + " && " + before + tool + arguments);
  }
  void add(const std::string& name, const std::string& options = "") const {
    REQUIRE((*this)(small + options + " --output " + name).exit_code == 0);
  }
  [[nodiscard]] std::string text(const std::string& name) const { return read_file(folder / name); }
  [[nodiscard]] bool has(const std::string& name) const { return fs::exists(folder / name); }
};

void check_contains(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    INFO(word);
    CHECK(contains(text, word));
  }
}

}  // namespace

TEST_CASE("a run is drawn as it ends, and again from its folder", "[picture]") {
  const Runs runs;
  const auto done = runs(small + "--output out --picture out/a.svg --picture-xt xt.svg");
  INFO(done.err);
  REQUIRE(done.exit_code == 0);
  CHECK(done.err.empty());
  check_contains(
      runs.text("out/a.svg"),
      {"</svg>", ">column large: tielen2017, p = 2, 8 cells, 32 particles<", ">t = 0.2 s<", ">exact<",
       ">(f)<", ">u, mm<", ">σ, kPa<", "J/m²<", ">kinetic<", ">gravity<", ">errors<", ">at X = 0.984 m<"});
  check_contains(runs.text("xt.svg"), {"<image", ">stress, kPa<", ">velocity, m/s<"});
  const auto particles = runs.text("out/particles.csv");
  CHECK(std::count(particles.begin(), particles.end(), '\n') == 1 + 201 * 32);  // rows of pixels

  REQUIRE(runs(" --picture b.svg out").exit_code == 0);
  CHECK(runs.text("b.svg") == runs.text("out/a.svg"));
  REQUIRE(runs(" --picture a.png out").exit_code == 0);
  CHECK(runs.text("a.png").starts_with("\x89PNG"));
  REQUIRE(runs(" --picture a.pdf out").exit_code == 0);
  CHECK(runs.text("a.pdf").starts_with("%PDF"));
}

TEST_CASE("a picture without exact solution says why", "[picture]") {
  const Runs runs;
  runs.add("out");
  REQUIRE(runs(" --picture a.svg --errors none out").exit_code == 0);
  check_contains(runs.text("a.svg"), {">--errors none was<"});
  CHECK_FALSE(contains(runs.text("a.svg"), ">exact<"));
  REQUIRE(runs(" --scene " HOMPM_SOURCE_DIR "/docs/scenes/contact.toml --quiet --picture b.svg").exit_code ==
          0);
  check_contains(runs.text("b.svg"), {">ends of the bodies<", ">no reference solution<", ">x, m<"});
  CHECK_FALSE(contains(runs.text("b.svg"), ">exact<"));
  REQUIRE(runs(" --case column --variant settled --end-time 0.1 --quiet --picture c.svg").exit_code == 0);
  check_contains(runs.text("c.svg"), {">the body had not come<"});
}

TEST_CASE("the state of rest is the exact solution at the end alone", "[picture]") {
  const Runs runs;
  REQUIRE(runs(" --case column --variant settled --cells 8 --scheme high-order --quiet --output out "
               "--picture c.svg")
              .exit_code == 0);
  check_contains(runs.text("c.svg"), {">exact<", ">errors<"});
}

TEST_CASE("runs of several schemes are compared in one picture", "[picture]") {
  const Runs runs;
  runs.add("a");
  runs.add("b", "--scheme high-order");
  runs.add("c", "--scheme high-order --degree 4");
  REQUIRE(runs(" --picture p.svg --picture-xt xt.svg a b c").exit_code == 0);
  check_contains(runs.text("p.svg"), {">tielen2017, p = 2, 8 cells<", ">high-order, p = 3, 8 cells<",
                                      ">high-order, p = 4, 8 cells<", ">error, stress<",
                                      ">stress, t = 0.1 s<", ">exact<", ">column large<"});
  check_contains(runs.text("xt.svg"), {">(f)<", ">high-order, p = 4, 8 cells: velocity, m/s<"});
  REQUIRE(runs(" --picture p.svg a a").exit_code == 0);
  check_contains(runs.text("p.svg"), {">a<"});
  runs.add("d", "--set material.youngs_modulus=2e5");
  const auto other = runs(" --picture q.svg a d");
  CHECK(other.exit_code == 2);
  CHECK(other.err ==
        "hompm-run: d: a run of another scene than a: here `youngs_modulus = 2e+05  # Pa`, there "
        "`youngs_modulus = 1e+05  # Pa` (see hompm-run --help)\n");
  CHECK_FALSE(runs.has("q.svg"));
}

TEST_CASE("without gnuplot the script is kept, and draws the same picture later", "[picture]") {
  const Runs runs;
  const std::string obstacle =
      "hompm-run: no picture: gnuplot is not installed (Debian package gnuplot-nox); its script is ";
  const auto done = runs(small + "--output out --picture " + quoted("it's.svg"), without_gnuplot);
  CHECK(done.exit_code == 0);  // the run is there
  CHECK(done.err == obstacle + "it's.gnuplot\n");
  const auto again = runs(" --picture sub/b.svg out", without_gnuplot);
  CHECK(again.exit_code == 5);
  CHECK(again.err == obstacle + "sub/b.gnuplot\n");
  CHECK_FALSE(runs.has("sub/b.svg"));
  REQUIRE(runs(" --picture b.svg out").exit_code == 0);
  REQUIRE(run_command("cd " + quoted((runs.folder / "sub").string()) + " && gnuplot b.gnuplot").exit_code ==
          0);
  CHECK(runs.text("sub/b.svg") == runs.text("b.svg"));
}

TEST_CASE("pictures that cannot be are refused in one line", "[picture]") {
  const Runs runs;
  runs.add("out");
  fs::create_directory(runs.folder / "empty");
  const auto check = [&](const std::string& arguments, int code, const std::string& message,
                         const std::string& before = "") {
    const auto done = runs(arguments, before);
    INFO(arguments << ": " << done.err);
    CHECK(done.exit_code == code);
    CHECK(done.err.starts_with("hompm-run: " + message));
    CHECK(done.err.find('\n') == done.err.size() - 1);
    for (const char* name : {"a.svg", "a.gnuplot", "hompm-out", ".hompm"}) CHECK_FALSE(runs.has(name));
  };
  check(" --case bar --picture a.svgz", 2,
        "--picture a.svgz: the name must end in .svg, .png or .pdf; did you mean .svg?");
  check(" --case bar --picture-xt a", 2, "--picture-xt a: the name must end in .svg, .png or .pdf");
  check(" --case bar out", 2, "`out` is not an option");
  check(" --case bar --picture a.svg out", 2, "--case is about a new run, and `out` one that is there");
  check(" --picture a.svg --errors some out", 2, "--errors some: there are auto, full, none");
  check(" --picture a.svg nowhere", 5, "cannot draw nowhere: it holds no run (scene.toml is missing)");
  check(" --picture a.svg empty", 5, "cannot draw empty: it holds no run (scene.toml is missing)");
  check(" --picture /proc/a.svg out", 5, "cannot write in /proc");
  check(" --picture a.svg out", 5, "cannot write", "ulimit -f 1; ");  // stands for a full disk
  const std::string history = runs.text("out/history.csv");
  write_file(runs.folder / "out/history.csv", "time,kinetic\n0,1\n");
  check(" --picture a.svg out", 5, "cannot draw out/history.csv");
  write_file(runs.folder / "out/history.csv", history);
  const std::string particles = runs.text("out/particles.csv");
  for (const char* name : {"particles.csv", "stress.csv"}) {  // the last row is missing
    const std::string text = runs.text(std::string("out/") + name);
    write_file(runs.folder / "out" / name, text.substr(0, text.rfind('\n', text.size() - 2) + 1));
  }
  check(" --picture a.svg out", 5, "cannot draw out: its particles.csv or stress.csv is not whole");
  write_file(runs.folder / "out/particles.csv", particles);
  check(" --picture a.svg out", 5, "cannot draw out");
  write_file(runs.folder / "out/stress.csv", "time,particle,X,x,stretch\n0,0,1,1,1\n");
  write_file(runs.folder / "out/particles.csv",
             "time,particle,X,x,displacement,velocity,volume,density\n0,0,1,1,0,0,1,1\n");
  check(" --picture a.svg out", 5, "cannot draw out: its particles.csv or stress.csv is not whole");
  fs::remove(runs.folder / "out/stress.csv");
  check(" --picture a.svg out", 5, "cannot draw out: it holds no run (stress.csv is missing)");
}
