// The states of a run from which its instructions are counted.
#include <string>

#include <hompm/error.hpp>
#include <hompm/kit/recorder/bytes.hpp>
#include <hompm/kit/study/measure.hpp>
#include <hompm/simulation/simulation.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/temporary_folder.hpp"

using hompm::FileError;
using hompm::Simulation;
using hompm::State;
using hompm::test::contains;
using hompm::test::message_of;
using hompm::test::read_file;
using hompm::test::TemporaryFolder;
using hompm::test::write_file;
namespace study = hompm::study;
using study::Study;

namespace {

const study::Check no_check = [] {};

std::string bytes_of(const State& state) {
  hompm::detail::ByteWriter out;
  hompm::detail::write_state(out, state);
  return out.bytes;
}

}  // namespace

TEST_CASE("what is stepped from are the states of the run, each but the first and the last", "[study]") {
  for (const char* scheme : {"high-order", "classical"}) {
    const Study study = {.case_name = "column",
                         .variant = "large",
                         .settings = {{"scheme.cells", "8"}, {"scheme.courant", "0.2"}, {"end_time", "0.4"}},
                         .sweeps = {{{"scheme.name", {scheme}}}}};
    const auto point = study::points_of(study).front();
    const auto measured = study::measure(study, point, "me", no_check);
    REQUIRE(static_cast<std::int64_t>(measured.moments.size()) == measured.record.work.steps - 1);
    Simulation simulation(study::scene_of(study, point), measured.stepping.time_step);
    for (const State& moment : measured.moments) {
      simulation.step();
      CHECK(bytes_of(simulation.state()) == bytes_of(moment));
    }
  }
}

TEST_CASE("states to step from come back as they were written", "[study]") {
  const Study study = {
      .case_name = "bar",
      .variant = "large",
      .settings = {{"scheme.cells", "8"}, {"end_time", "0.1"}, {"scheme.step_fraction", "0.05"}},
      .sweeps = {{}}};
  const auto measured = study::measure(study, study::points_of(study).front(), "me", no_check);
  const TemporaryFolder folder;
  study::write_moments(folder.path(), measured);
  CHECK(study::step_from_moments(folder.path()) == static_cast<std::int64_t>(measured.moments.size()));
  State state = initial_state(study::scene_of(study, study::points_of(study).front()));
  const std::string written = bytes_of(measured.moments.back());
  hompm::detail::ByteReader in(written);
  hompm::detail::read_state(in, state);
  CHECK(bytes_of(state) == written);

  const std::string bytes = read_file(folder / "moments");
  for (const std::string& cut : {bytes.substr(0, bytes.size() - 8), std::string("x")}) {
    write_file(folder / "moments", cut);
    CHECK(
        contains(message_of<FileError>([&] { study::step_from_moments(folder.path()); }), "ends too early"));
  }
  CHECK(contains(message_of<FileError>([&] { study::write_moments(folder / "moments", measured); }),
                 "moments"));
}
