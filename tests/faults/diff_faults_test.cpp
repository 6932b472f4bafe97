// Faults 6 and 19: what hompm-diff agreed with, or said wrongly.
#include <filesystem>
#include <string>
#include <sys/stat.h>

#include <hompm/kit/verify/foreign_comparison.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/run_command.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using namespace hompm::test;
using hompm::compare_foreign;
using hompm::ForeignOptions;
using hompm::Verdict;

namespace {

const std::string golden = HOMPM_SOURCE_DIR "/golden/bar-small-classical";
const std::string diff = quoted(HOMPM_BIN_DIR "/hompm-diff") + " ";

CommandResult run(const std::string& arguments) { return run_command("timeout 60 " + diff + arguments); }

/// A folder with results at one time: rows of body, X and velocity.
fs::path folder_of(const TemporaryFolder& folder, const std::string& rows, bool with_scene = false) {
  write_file(folder / "b/particles.csv", "time,body,X,velocity\n" + rows);
  if (with_scene) {
    write_file(folder / "b/scene.toml",
               "case = \"flight\"\nend_time = 1.0\n[body]\nlength = 1.0\n[material]\nlaw = \"linear\"\n"
               "density = 1.0\nyoungs_modulus = 100.0\n[scheme]\nname = \"classical\"\ncells = 1\n"
               "particles_per_cell = 1\ntime_step = 1e-3\n[ends]\nleft = \"free\"\nright = \"free\"\n");
  }
  return folder / "b";
}

}  // namespace

TEST_CASE("one particle of golden matches only what is where it is", "[faults]") {  // 6
  const bool with_scene = GENERATE(true, false);
  const TemporaryFolder folder;
  const fs::path b = folder_of(folder, "0,0,0.5,3\n", with_scene);
  const fs::path a = folder / "a.csv";
  const ForeignOptions all{.tolerances = {{"velocity", {.relative = 1e-3}}}};
  const auto verdict = [&](const std::string& rows) {
    write_file(a, "time,X,velocity\n" + rows);
    return compare_foreign(a, b, all);
  };
  CHECK(verdict("0,0.5,3\n").verdict == Verdict::identical);
  // Two particles where there is one, on either side of it: neither a crash nor an agreement.
  for (const std::string rows : {"0,0.5,3\n0,0.75,3\n", "0,0.25,3\n0,0.5,3\n", "0,0.25,3\n0,0.75,3\n"}) {
    const auto result = verdict(rows);
    CHECK(result.verdict == Verdict::different);
    CHECK_FALSE(result.messages.empty());
  }
  const auto far = verdict("0,76.5,3\n");
  CHECK(far.verdict == Verdict::different);
  CHECK(contains(far.messages.front(), "none of the 1 particles at time 0 has the X"));
  // A thousandth of the cell, which is 1 m; without one nothing but rounding.
  CHECK((verdict("0,0.5009,3\n").verdict == Verdict::identical) == with_scene);
  CHECK(verdict("0,0.5011,3\n").verdict == Verdict::different);
  CHECK(verdict("0,0.50000000000000011,3\n").verdict == Verdict::identical);
}

TEST_CASE("bodies that overlap in X are told apart by their number", "[faults]") {  // 19
  const TemporaryFolder folder;
  const fs::path b =
      folder_of(folder, "0,0,0.25,3\n0,0,0.75,3\n0,1,0.5,-1\n0,1,0.75,-1\n", GENERATE(true, false));
  CHECK(compare_foreign(b / "particles.csv", b, {}).verdict == Verdict::identical);
  const fs::path a = folder / "a.csv";
  write_file(a, "body,time,X,velocity\n1,0,0.75,-1\n0,0,0.25,3\n1,0,0.5,-1\n0,0,0.75,3\n");
  CHECK(compare_foreign(a, b, {}).verdict == Verdict::identical);
  write_file(a, "body,time,X,velocity\n0,0,0.75,-1\n0,0,0.25,3\n1,0,0.5,-1\n1,0,0.75,3\n");
  CHECK(compare_foreign(a, b, {}).verdict == Verdict::different);
  write_file(a, "time,X,velocity\n0,0.25,3\n0,0.5,-1\n0,0.75,3\n0,0.8,1\n");
  const auto result = compare_foreign(a, b, {});
  CHECK(result.verdict == Verdict::different);
  CHECK(contains(result.messages.front(), "bodies of B overlap at time 0: a column `body` has to tell"));
}

TEST_CASE("hompm-diff says what a file is that it cannot read", "[faults]") {  // 19
  const TemporaryFolder folder;
  const auto check = [&](const std::string& name, const std::string& bytes, const std::string& message) {
    write_file(folder / name, bytes);
    const auto result = run(quoted((folder / name).string()) + " " + golden);
    INFO(name << ": " << result.err);
    CHECK(result.exit_code == 5);
    CHECK(result.out.empty());
    CHECK(contains(result.err, "cannot read " + (folder / name).string()));
    CHECK(contains(result.err, message));
    CHECK(result.err.find('\n') == result.err.size() - 1);
  };
  check("a.mat", "MATLAB 5.0 MAT-file, Platform: GLNXA64", "a MATLAB file: in Octave");
  check("a.h5", "\x89HDF\r\n\x1a\n", "an HDF5 file");
  check("a.vtk", "# vtk DataFile Version 3.0\n", "a legacy VTK file: `meshio convert");
  check("a.npy", "\x93NUMPY", "numpy.savetxt");
  check("a.bin", std::string("ab\0\1", 4), "this is not text");
  check("a.vtu", "<VTKFile type=\"UnstructuredGrid\"><Unstr", "this is not whole XML");
  check("b.vtu", "<VTKFile type=\"ImageData\"><ImageData/></VTKFile>", "only UnstructuredGrid (.vtu)");
  check("c.vtu", "<svg/>", "this is XML, but no VTK file");
  check("a.dump", "ITEM: TIMESTEP\n0\n", "there is no ITEM: ATOMS in this dump");
  check("b.dump", "ITEM: TIMESTEP\n0\nITEM: ATOMS id x\n1 0\n", "--time-step T says how long one is");
  check("a.gz", std::string("\x1f\x8b\x08\0\0\0\0\0\0\3\xff\xff\xff", 13),
        "the compressed file is cut or damaged");
  check("a.csv", "0.5,1,2\n", "there is no header");
  const std::string missing = (folder / "missing.csv").string();
  for (const std::string options : {"", "--exact all=1 ", "--time 0 "}) {
    const auto result = run(options + missing + " " + golden);
    CHECK(result.exit_code == 5);
    CHECK(result.err == "hompm-diff: cannot read " + missing + ": No such file or directory\n");
  }
}

TEST_CASE("hompm-diff says that its arguments are the wrong way round, and reads pipes", "[faults]") {  // 19
  const TemporaryFolder folder;
  const std::string particles = golden + "/particles.csv";
  const auto swapped = run(golden + " " + particles);
  CHECK(swapped.exit_code == 2);
  CHECK(contains(swapped.err,
                 particles + " is a file, " + golden + " a folder: a file of another code comes first"));
  const auto both = run(particles + " " + particles);
  CHECK(both.exit_code == 5);
  CHECK(contains(both.err, "it is not a folder, nor a scene file"));
  const auto nowhere = run(particles + " bar-smal");
  CHECK(nowhere.exit_code == 5);
  CHECK(contains(nowhere.err, "no such folder or scene file, and the built-in cases are bar-"));

  CHECK(run_command("cat " + particles + " | timeout 60 " + diff + "- " + golden)
            .out.starts_with("identical\n"));
  CHECK(run_command("cat " + particles + " | timeout 60 " + diff + "/dev/stdin " + golden).exit_code == 0);
  const std::string pipe = (folder / "pipe").string();
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(run_command("cat " + particles + " > " + pipe + " & timeout 60 " + diff + pipe + " " + golden)
            .exit_code == 0);
  CHECK(run_command("gzip -c " + particles + " | timeout 60 " + diff + "- " + golden).exit_code == 0);
}
