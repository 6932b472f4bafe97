// hompm-run as its users meet it: outputs, exit codes, and what it says about bad input.
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <hompm/effects/registry.hpp>
#include <hompm/kit/scene_file/reader.hpp>

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

const std::string tool = HOMPM_BIN_DIR "/hompm-run";
/// A run of a few milliseconds.
const std::string quick = " --case bar --cells 8 --end-time 0.01";

std::vector<std::string> files_below(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) names.push_back(fs::relative(entry.path(), folder).string());
  std::sort(names.begin(), names.end());
  return names;
}

std::size_t count_lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_CASE("hompm-run warns of update stress last with hat functions at a free end that moves, and runs") {
  const TemporaryFolder scratch;
  const auto said = [&](const std::string& options) {
    const auto done = run_command(tool + " --case column --end-time 0.01 --no-vtk " + options + " --output " +
                                  quoted((scratch / "out").string()));
    CHECK(done.exit_code == 0);
    return done.err;
  };
  CHECK_THAT(said("--scheme apic --degree 1"),
             contains("hompm-run: warning: scheme.sequence = \"usl\" with hat functions"));
  CHECK_THAT(said("--scheme classical --set scheme.sequence=usl"), contains("\"musl\" was made for that"));
  CHECK(said("--scheme apic --degree 1 --quiet").empty());
  CHECK(said("--scheme apic").empty());
  CHECK(said("--scheme classical").empty());
  CHECK(said("--scheme apic --degree 1 --set ends.right=fixed").empty());
  CHECK(said("--scheme apic --degree 1 --variant small --set material.law=linear "
             "--set kinematics=infinitesimal")
            .empty());
}

TEST_CASE("hompm-run leaves a whole folder, and the same bytes the second time") {
  const TemporaryFolder scratch;
  const auto first =
      run_command("cd " + quoted(scratch.path().string()) + " && " + tool + quick + " --snapshots 2");
  INFO(first.err);
  REQUIRE(first.exit_code == 0);
  const fs::path folder = scratch / "hompm-out/bar-large-tielen2017-p2-8";
  CHECK(files_below(folder) == std::vector<std::string>{"history.csv", "particles.csv", "run.json", "run.pvd",
                                                        "scene.toml", "stress.csv", "timing.json",
                                                        "vtk/snapshot_0000.vtu", "vtk/snapshot_0001.vtu",
                                                        "vtk/snapshot_0002.vtu"});
  const auto particles = read_file(folder / "particles.csv");
  CHECK(particles.substr(0, particles.find('\n')) ==
        "time,particle,X,x,displacement,velocity,volume,density");
  CHECK(count_lines(particles) == 1 + 3 * 32);
  const auto stress = read_file(folder / "stress.csv");
  CHECK(stress.substr(0, stress.find('\n')) == "time,particle,X,x,stress,stretch");
  const auto history = read_file(folder / "history.csv");
  CHECK(history.rfind("time,kinetic,stored,gravity,dissipated,external_work,residual", 0) == 0);

  REQUIRE(run_command(tool + quick + " --snapshots 2 --output " + quoted(scratch / "again")).exit_code == 0);
  for (const auto& name : files_below(folder))
    if (name != "timing.json") CHECK(read_file(folder / name) == read_file(scratch / "again" / name));
}

TEST_CASE("a resolved scene reproduces its run") {
  const TemporaryFolder scratch;
  REQUIRE(run_command(
              tool +
              " --case column --scheme bspline --degree 3 --cells 8 --courant 0.1 --end-time 0.01 --output " +
              quoted(scratch / "a"))
              .exit_code == 0);
  REQUIRE(run_command(tool + " --scene " + quoted(scratch / "a/scene.toml") + " --output " +
                      quoted(scratch / "b"))
              .exit_code == 0);
  for (const char* name : {"scene.toml", "particles.csv", "stress.csv", "history.csv", "run.json"})
    CHECK(read_file(scratch / "a" / name) == read_file(scratch / "b" / name));
}

TEST_CASE("with --json it prints run.json, with what others script against") {
  const TemporaryFolder scratch;
  const auto done = run_command(tool + quick + " --json --no-vtk --output " + quoted(scratch / "out"));
  REQUIRE(done.exit_code == 0);
  CHECK(done.out == read_file(scratch / "out/run.json"));
  CHECK(done.err.empty());
  const auto json = nlohmann::json::parse(done.out);
  CHECK(json["case"] == "bar");
  CHECK(json["variant"] == "large");
  CHECK(json["scheme"] == "tielen2017");
  CHECK(json["degree"] == 2);
  CHECK(json["cells"] == 8);
  CHECK(json["particles_per_cell"] == 4);
  CHECK(json["particles"] == 32);
  CHECK(json["time_step"] == 1e-4);
  CHECK(json["steps"] == 100);
  CHECK(json["end_time"] == 0.01);
  CHECK(json["critical_time_step"].get<double>() > 0.1);
  for (const char* field : {"displacement", "velocity", "stress"})
    for (const char* norm : {"relative_l2", "rms", "max"})
      CHECK(json["errors"][field][norm].get<double>() > 0.0);
  CHECK(json["errors"]["reference"].get<std::string>().size() > 10);
  CHECK(json["energy"].contains("residual"));
  for (const char* key : {"compiler", "flags", "version", "commit"}) CHECK(json["build"].contains(key));
  CHECK_FALSE(fs::exists(scratch / "out/vtk"));
}

TEST_CASE("the summary says what was run and how good it is") {
  const TemporaryFolder scratch;
  const auto done =
      run_command(tool + " --case column --cells 16 --end-time 0.1 --output " + quoted(scratch / "out"));
  REQUIRE(done.exit_code == 0);
  for (const char* part : {"column large", "tielen2017 of degree 2", "16 cells x 4 = 64 particles",
                           "critical step", "displacement", "energy", "momentum", "mass", "files"})
    CHECK_THAT(done.out, contains(part));
  CHECK(done.err.empty());
  CHECK(run_command(tool + quick + " --quiet --output " + quoted(scratch / "quiet")).out.empty());
}

TEST_CASE("listing, explaining, help and version run nothing") {
  const TemporaryFolder scratch;
  const std::string here = "cd " + quoted(scratch.path().string()) + " && ";
  const auto list = run_command(here + tool + " --list");
  CHECK(list.exit_code == 0);
  for (const char* part : {"bar", "column", "settled", "classical", "bspline", "tielen2017", "hencky",
                           "gravity", "local-damping"})
    CHECK_THAT(list.out, contains(part));
  const auto explain = run_command(here + tool + " --case column --explain");
  CHECK(explain.exit_code == 0);
  CHECK_THAT(explain.out, contains("effect gravity (built-in scene column-large:"));
  CHECK_THAT(explain.out, contains("effects absent: traction, mass-damping, local-damping"));
  CHECK_THAT(run_command(here + tool + " --case bar --explain").out,
             !contains("gravity:") && !contains("external force"));
  const auto keys = run_command(here + tool + " --keys");
  CHECK(keys.exit_code == 0);
  for (const char* part : {"body.length [m]: number, > 0; must be given\n",
                           "output.snapshots: whole number, 1 … 10000; default: 10\n",
                           "rest.speed [m/s]: number, > 0; must be given where [rest] is\n",
                           "  end: left, right; default: \"left\"\n"})
    CHECK_THAT(keys.out, contains(part));
  const auto reference = nlohmann::json::parse(run_command(here + tool + " --keys --json").out);
  CHECK(reference["keys"].size() == hompm::scene_keys().size());
  CHECK(reference["effects"].size() == hompm::effect_catalogue().size());
  CHECK_THAT(run_command(here + tool + " --help").out, contains("usage: hompm-run"));
  CHECK_THAT(run_command(here + tool + " --version").out, contains("hompm-run 0."));
  CHECK(fs::is_empty(scratch.path()));
}

TEST_CASE("bad usage and bad scenes: exit 2, one clear line, nothing written") {
  const TemporaryFolder scratch;
  write_file(scratch / "typo.toml",
             "end_time = 1\n[body]\nlength = 1\n[material]\nlaw = \"rat\"\ndensity = 1\nyoungs_modulus = 1\n"
             "[scheme]\ncells = 4\nparticles_per_cell = 4\ntime_step = 1e-3\n");
  struct Bad {
    std::string arguments, message;
  };
  const auto& bad = GENERATE(values<Bad>({
      {"", "usage"},
      {"--case colum", "did you mean column"},
      {"--case column --variant lagre", "large"},
      {"--case bar --scheme tielen2071", "tielen2017"},
      {"--case bar --scheme classical --degree 2", "1"},
      {"--case bar --degree 9", "--degree 9"},
      {"--case bar --cells -3", "from 1 to"},
      {"--case bar --cells 0", "--cells 0"},
      {"--case bar --cells 2.5", "--cells 2.5"},
      {"--case bar --time-step nan", "--time-step nan"},
      {"--case bar --time-step -1", "--time-step -1"},
      {"--case bar --time-step 1e-4x", "--time-step 1e-4x"},
      {"--case bar --end-time inf", "--end-time inf"},
      {"--case bar --time-step 1e-4 --courant 0.1", "courant"},
      {"--case bar --courant 3", "above the critical step"},
      {"--case bar --set scheme.celsl=4", "scheme.cells"},
      {"--case bar --set scheme.cells", "KEY=VALUE"},
      {"--case column --set effect.gravty.acceleration=1", "gravity"},
      {"--case bar --snapshot 3", "--snapshots"},
      {"--case bar --scene x.toml", "exclude"},
      {"--variant large", "--case"},
      {"--quiet", "nothing to run"},
      {"--case bar extra", "`extra`"},
      {"--scene typo.toml", "typo.toml:5:7"},
  }));
  const auto done =
      run_command("cd " + quoted(scratch.path().string()) + " && " + tool + " " + bad.arguments);
  INFO(bad.arguments << " -> " << done.err);
  CHECK(done.exit_code == 2);
  CHECK(done.out.empty());
  CHECK_THAT(done.err, contains(bad.message));
  if (!bad.arguments.empty()) {
    CHECK(count_lines(done.err) == 1);
    CHECK(done.err.rfind("hompm-run: ", 0) == 0);
  }
  CHECK(files_below(scratch.path()) == std::vector<std::string>{"typo.toml"});
}

TEST_CASE("what cannot be read or written: exit 5") {
  const TemporaryFolder scratch;
  CHECK(run_command(tool + " --scene " + quoted(scratch / "none.toml")).exit_code == 5);
  CHECK(run_command(tool + " --check " + quoted(scratch / "none")).exit_code == 5);
  write_file(scratch / "file", "");
  const auto under_file = run_command(tool + quick + " --output " + quoted(scratch / "file/out"));
  CHECK(under_file.exit_code == 5);
  CHECK_THAT(under_file.err, contains("/file") && contains("Not a directory"));
  CHECK(run_command(tool + quick + " --output /proc/hompm").exit_code == 5);
  const auto full =
      run_command("trap '' XFSZ; ulimit -f 8; " + tool + quick + " --output " + quoted(scratch / "full"));
  CHECK(full.exit_code == 5);
  CHECK_THAT(full.err, contains("File too large"));
  CHECK_FALSE(fs::exists(scratch / "full"));
  CHECK(run_command(tool + quick + " --output " + quoted(scratch / "out") + " >/dev/full").exit_code == 5);
}

TEST_CASE("a run that becomes invalid: exit 4 says when and why, and leaves no result") {
  const TemporaryFolder scratch;
  const std::string unstable = tool +
                               " --case bar --set scheme.allow_unstable=true --time-step 0.07 --output " +
                               quoted(scratch / "out");
  REQUIRE(run_command(tool + quick + " --output " + quoted(scratch / "out")).exit_code == 0);
  const auto done = run_command(unstable + " --end-time 50");
  INFO(done.err);
  CHECK(done.exit_code == 4);
  CHECK_THAT(done.err, contains("hompm-run: invalid at step ") && contains("t = "));
  CHECK(count_lines(done.err) == 1);
  CHECK(files_below(scratch / "out") ==
        std::vector<std::string>{"invalid/last_valid.csv", "invalid/reason.txt"});
  CHECK_THAT(read_file(scratch / "out/invalid/reason.txt"), contains("invalid at step"));
  // and the next good run clears that up
  REQUIRE(run_command(tool + quick + " --no-vtk --output " + quoted(scratch / "out")).exit_code == 0);
  CHECK_FALSE(fs::exists(scratch / "out/invalid"));
}

TEST_CASE("with --check it runs a golden scene and compares: 0 identical, 3 different, 2 another scene") {
  const TemporaryFolder scratch;
  const std::string golden = quoted(scratch / "golden");
  REQUIRE(run_command(tool + quick + " --snapshots 2 --no-vtk --output " + golden).exit_code == 0);
  const std::string check = tool + " --output " + quoted(scratch / "out") + " --check " + golden;
  const auto same = run_command(check);
  CHECK(same.exit_code == 0);
  CHECK_THAT(same.out, contains("identical"));
  CHECK(run_command(check + quick).exit_code == 0);

  const auto other = run_command(check + " --case bar --cells 9 --end-time 0.01");
  CHECK(other.exit_code == 2);
  CHECK_THAT(other.err, contains("another scene") && contains("cells = 9") && contains("cells = 8"));

  auto stress = read_file(scratch / "golden/stress.csv");
  const auto digit = stress.find_last_of("123456789");
  stress[digit] = stress[digit] == '1' ? '2' : '1';
  write_file(scratch / "golden/stress.csv", stress);
  const auto different = run_command(check);
  CHECK(different.exit_code == 3);
  CHECK_THAT(different.out, contains("different") && contains("stress.csv"));
  CHECK_THAT(run_command(check + " --quiet").err, contains("different"));
}

TEST_CASE("the VTU of several bodies says which particle is whose") {
  const TemporaryFolder scratch;
  REQUIRE(run_command(tool + " --scene " HOMPM_SOURCE_DIR "/docs/scenes/contact.toml --quiet --output " +
                      quoted(scratch / "out"))
              .exit_code == 0);
  for (const auto& entry : fs::recursive_directory_iterator(scratch / "out"))
    if (entry.path().extension() == ".vtu") CHECK_THAT(read_file(entry.path()), contains("Name=\"body\""));
}

TEST_CASE("the last line says whether to believe a run, and run.json the same") {
  const TemporaryFolder scratch;
  const std::string out = " --no-vtk --output " + quoted((scratch / "out").string());
  const std::string hats = tool + " --case column --scheme classical --cells 16 --time-step 1e-3";
  const auto done = run_command(hats + out);
  CHECK(done.exit_code == 0);
  const auto last = done.out.substr(done.out.rfind('\n', done.out.size() - 2) + 1);
  CHECK_THAT(last, contains("  verdict   bad: ") && contains("particles crossed cells with hat functions"));
  const auto json = nlohmann::json::parse(read_file(scratch / "out/run.json"));
  CHECK(json["verdict"]["level"] == "bad");
  CHECK(json["verdict"]["cause"]["code"] == "grid-crossing");
  CHECK("  verdict   " + std::string(json["verdict"]["text"]) + "\n" == last);
  CHECK(json["errors"]["kind"] == "computed");
  CHECK(json["errors"]["bound"]["stress"] >= json["errors"]["stress"]["relative_l2"]);
  const auto none = nlohmann::json::parse(run_command(tool + quick + " --json --errors none" + out).out);
  CHECK(none["verdict"]["level"] == "unknown");
  CHECK(none["verdict"]["cause"].is_null());
  CHECK(none["errors"]["kind"] == "none");
}

TEST_CASE(
    "a scene without a known solution is judged by runs of a better scheme, of the same bytes each time") {
  const TemporaryFolder scratch;
  const std::string scene =
      tool + " --scene " HOMPM_SOURCE_DIR "/docs/scenes/contact.toml --cells 8 --no-vtk";
  const auto json = [&](const std::string& options) {
    return run_command(scene + options + " --json --output " + quoted((scratch / "out").string())).out;
  };
  const auto first = json("");
  const auto errors = nlohmann::json::parse(first)["errors"];
  CHECK(errors["kind"] == "extrapolated");
  CHECK_THAT(std::string(errors["reference"]), contains("runs by high-order on up to "));
  CHECK(json("") == first);
  CHECK_THAT(nlohmann::json::parse(json(" --errors none"))["errors"].dump(), !contains("bound"));
}

TEST_CASE("option --require: exit 3 unless the run is known to be as good, with the number and what helps") {
  const TemporaryFolder scratch;
  const auto done = [&](const std::string& options) {
    return run_command(tool + " --case bar --cells 16 --end-time 0.5 --time-step 1e-3 --quiet --output " +
                       quoted((scratch / "out").string()) + options);
  };
  CHECK(done(" --require stress=0.1 --require velocity=0.1").exit_code == 0);
  CHECK_THAT(read_file(scratch / "out/scene.toml"), contains("[require]\nvelocity = 0.1\nstress = 0.1\n"));
  const auto worse = done(" --require stress=1e-9");
  CHECK(worse.exit_code == 3);
  CHECK_THAT(worse.err, contains("hompm-run: stress is to be good to 1e-09, and is good to "));
  CHECK(fs::exists(scratch / "out/run.json"));
  const auto unknown = done(" --require stress=0.1 --errors none");
  CHECK(unknown.exit_code == 3);
  CHECK_THAT(unknown.err, contains("and is not known: ") && contains("--errors none was given"));
  const auto misspelt = done(" --require stres=0.1");
  CHECK(misspelt.exit_code == 2);
  CHECK_THAT(misspelt.err,
             contains("--require stres=0.1: ") && contains("did you mean") && contains("stress"));
  CHECK_THAT(done(" --require stress=0").err,
             contains("--require stress=0: `require.stress` must be a number greater than 0, not 0"));
  CHECK_THAT(done(" --require stress").err,
             contains("--require stress: expected FIELD=BOUND, as in --require stress=1e-2"));
}

TEST_CASE("option --require goes with a golden folder and with a run that is resumed") {
  const TemporaryFolder scratch;
  const std::string out = " --quiet --no-vtk --output " + quoted((scratch / "out").string());
  const std::string golden = tool + " --check " HOMPM_SOURCE_DIR "/golden/bar-small-high-order" + out;
  CHECK(run_command(golden + " --require displacement=1e-6").exit_code == 0);
  CHECK(run_command(golden + " --require displacement=1e-12").exit_code == 3);
  REQUIRE(run_command(tool + quick + " --keep-checkpoint" + out).exit_code == 0);
  const auto resumed = run_command(tool + " --resume " + quoted((scratch / "out").string()) +
                                   " --end-time 0.02 --quiet --require stress=1e-12");
  CHECK(resumed.exit_code == 3);
}
