// What the run folder does when data is bad or the disk says no.
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

#include <hompm/error.hpp>
#include <hompm/kit/output/run_folder.hpp>
#include <hompm/kit/output/staging.hpp>
#include <hompm/kit/output/text_file.hpp>

#include "support/catch.hpp"
#include "support/file_size_limit.hpp"
#include "support/message_of.hpp"
#include "support/sample_run.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using namespace hompm::test;
using hompm::RunFolder;

namespace {

/// Root may write everywhere; as long as this lives, the process may not.
class Unprivileged {
 public:
  Unprivileged() {
    if (::geteuid() == 0 && ::seteuid(65534) != 0) throw std::runtime_error("seteuid failed");
  }
  ~Unprivileged() {
    if (::seteuid(::getuid()) != 0) std::abort();
  }
  Unprivileged(const Unprivileged&) = delete;
  Unprivileged& operator=(const Unprivileged&) = delete;
};

}  // namespace

TEST_CASE("a value that is not finite never reaches a file", "[output]") {
  const TemporaryFolder folder;
  RunFolder run(folder.path(), true);
  const double bad =
      GENERATE(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
               -std::numeric_limits<double>::infinity());
  auto snapshot = sample_snapshot(0.5, 8);
  snapshot.velocity[7] = bad;
  CHECK(message_of<hompm::Error>([&] { run.write(snapshot); }) ==
        "velocity of particle 7 at time 0.5 is not finite and cannot be written");
  auto row = sample_history(0.5);
  row.stored = bad;
  CHECK(message_of<hompm::Error>([&] { run.write(row); }) ==
        "stored at time 0.5 is not finite and cannot be written");
  snapshot = sample_snapshot(0.5, 8);
  snapshot.density.pop_back();
  CHECK(contains(message_of<hompm::Error>([&] { run.write(snapshot); }),
                 "7 values of density for 8 particles"));

  run.write(sample_snapshot(0.5, 1));  // what was refused left the files as they were
  run.publish();
  CHECK(contains(read_file(folder / "vtk/snapshot_0000.vtu"), "NumberOfPoints=\"1\""));
  CHECK(contains(read_file(folder / "particles.csv"), "density\n0.5,0,"));
}

TEST_CASE("a folder that cannot be had is an error with path and reason", "[output]") {
  const TemporaryFolder folder;
  SECTION("below a regular file") {
    write_file(folder / "file", "text");
    const auto message = message_of<hompm::FileError>([&] { RunFolder(folder / "file/out", false); });
    INFO(message);
    CHECK(contains(message, (folder / "file").string() + ": Not a directory"));
    CHECK(read_file(folder / "file") == "text");
  }
  SECTION("read-only") {
    ::chmod(folder.path().c_str(), 0555);
    const Unprivileged guard;
    for (const auto& path : {folder.path(), folder / "new"}) {
      const auto message = message_of<hompm::FileError>([&] { RunFolder(path, false); });
      INFO(message);
      CHECK(contains(message, path.string()));
      CHECK(contains(message, ": Permission denied"));
    }
  }
  SECTION("without a name") {
    CHECK_FALSE(message_of<hompm::FileError>([] { RunFolder("", false); }).empty());
  }
  SECTION("partly created before it failed") {
    const auto path = folder / "a" / "b" / std::string(300, 'x');
    CHECK(contains(message_of<hompm::FileError>([&] { RunFolder(path, false); }), ": File name too long"));
    CHECK(fs::is_empty(folder.path()));
  }
}

TEST_CASE("a full disk is an error and no half-written run is published", "[output]") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "out");
  {
    RunFolder run(folder / "out", true);
    const auto large = sample_snapshot(0.0, 20000);
    {
      const FileSizeLimit limit(100000);
      const auto message = message_of<hompm::FileError>([&] { run.write(large); });
      INFO(message);
      CHECK(contains(message, (folder / "out/particles.csv").string() + ": File too large"));
    }
    CHECK_FALSE(message_of<hompm::Error>([&] { run.write(large); }).empty());
    CHECK_FALSE(message_of<hompm::Error>([&] { run.publish(); }).empty());
  }
  CHECK(fs::is_empty(folder / "out"));
  {
    RunFolder run(folder / "out", false);
    run.write(
        sample_snapshot(0.0, 1000));  // stays in the buffer: the disk is only seen to be full at the end
    const FileSizeLimit limit(1000);
    CHECK(contains(message_of<hompm::FileError>([&] { run.publish(); }), ": File too large"));
  }
  CHECK(fs::is_empty(folder / "out"));

  hompm::detail::TextFile full("/dev/full", "/dev/full");
  full << "text";
  CHECK(message_of<hompm::FileError>([&] { full.close(); }) ==
        "cannot write /dev/full: No space left on device");
}

TEST_CASE("a folder whose replacement failed half-way does not look complete", "[output]") {
  const TemporaryFolder folder;
  write_sample_run(folder.path(), 2);
  fs::remove(folder / "stress.csv");
  fs::create_directory(folder / "stress.csv");
  RunFolder run(folder.path(), false);
  run.write("run.json", "{}\n");
  const auto message = message_of<hompm::FileError>([&] { run.publish(); });
  INFO(message);
  CHECK(contains(message, (folder / "stress.csv").string() + ": Is a directory"));
  CHECK_FALSE(fs::exists(folder / "run.json"));
}

TEST_CASE("a file whose place is taken by a folder stays behind, and the folder is told", "[output]") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "here");
  hompm::detail::StagingFolder staging(folder.path());
  staging.create("here").close();
  CHECK(contains(message_of<hompm::FileError>([&] { staging.move_into_place("here"); }),
                 (folder / "here").string() + ": Is a directory"));
  CHECK(staging.names().count("here") == 1);
  CHECK(fs::is_directory(folder / "here"));
}
