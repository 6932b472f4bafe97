// A run that goes on from a checkpoint is the run that never stopped, and nothing else passes for a
// checkpoint.
#include <cstring>
#include <string>

#include <hompm/build_info.hpp>
#include <hompm/error.hpp>
#include <hompm/kit/recorder/bytes.hpp>
#include <hompm/kit/recorder/checkpoint.hpp>
#include <hompm/scheme/scheme.hpp>
#include <hompm/simulation/simulation.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/recorded_run.hpp"
#include "support/scenes.hpp"

using namespace hompm::test;
using hompm::Checkpoint;
using hompm::CheckpointError;

namespace {

/// Equal bit for bit: memcmp tells −0 from 0.
bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

Checkpoint through_bytes(const Checkpoint& checkpoint) {
  return hompm::parse_checkpoint(checkpoint_bytes(checkpoint), "test");
}

void check_resuming(const hompm::Scene& scene, std::int64_t every) {
  const RecordedRun whole = record_run(scene, every);
  REQUIRE(whole.points.size() >= 3);
  for (const Checkpoint& point : whole.points) {
    const Checkpoint read = through_bytes(point);
    const RecordedRun rest = record_run(read.scene, every, &read);
    INFO("from step " << point.point.states.front().step);
    CHECK(same_bits(numbers_of(rest), numbers_of(whole)));
    // what it would go on from later is the same, too
    if (!rest.points.empty())
      CHECK((checkpoint_bytes(rest.points.back()) == checkpoint_bytes(whole.points.back())));
  }
}

std::string reason(const std::string& bytes) {
  return message_of<CheckpointError>([&] { hompm::parse_checkpoint(bytes, "file"); });
}

/// With the hash that belongs to the changed content: what only another hompm could have written.
std::string with_new_hash(std::string bytes) {
  hompm::detail::ByteWriter hash;
  hash.word(hompm::detail::hash_of_bytes(std::string_view(bytes).substr(40)));
  return bytes.replace(32, 8, hash.bytes);
}

std::string replaced(std::string text, const std::string& part, const std::string& by) {
  const auto at = text.find(part);
  REQUIRE(at != text.npos);
  return text.replace(at, part.size(), by);
}

}  // namespace

TEST_CASE("a resumed run is bit-equal, for every scheme, degree, integrator, kinematics and effect") {
  const auto& scheme = GENERATE(from_range(hompm::scheme_table()));
  const std::string kinematics = GENERATE("finite", "infinitesimal");
  for (const std::string integrator : {"euler-cromer", "leapfrog", "blanes-moan"})
    for (int degree = scheme.lowest_degree; degree <= scheme.highest_degree; ++degree) {
      INFO(scheme.name << " of degree " << degree << ", " << integrator << ", " << kinematics);
      check_resuming(busy_scene(scheme.name, degree, integrator, kinematics), 17);
    }
}

TEST_CASE("a resumed run of several bodies is bit-equal, body by body") {
  const std::string scheme = GENERATE(as<std::string>{}, "classical", "tielen2017", "high-order");
  for (const std::string integrator : {"euler-cromer", "leapfrog"}) {
    INFO(scheme << ", " << integrator);
    check_resuming(colliding_bars(integrator, scheme), 7);
  }
}

TEST_CASE("a resumed run comes to rest in the same step") {
  const auto scene = built_in("column", "settled",
                              {{"scheme.cells", "4"}, {"rest.speed", "1e-2"}, {"scheme.time_step", "2e-3"}});
  const auto whole = record_run(scene, 1);
  REQUIRE(whole.result.at_rest);
  check_resuming(scene, whole.result.steps / 5);
  // In the last steps before rest the quiet ones so far must be remembered.
  const Checkpoint& late = *(whole.points.end() - 3);
  CHECK(late.point.quiet_steps > 3);
  const auto read = through_bytes(late);
  CHECK(record_run(scene, 0, &read).result.steps == whole.result.steps);
}

TEST_CASE("a resumed run becomes invalid in the same step for the same reason") {
  const auto scene = built_in(
      "bar", "large", {{"scheme.allow_unstable", "true"}, {"scheme.time_step", "0.07"}, {"end_time", "50"}});
  std::optional<Checkpoint> point;
  hompm::RunObserver observer;
  observer.checkpoint_every = 2;
  observer.checkpoint = [&](const hompm::RunPoint& p) {
    point = hompm::first_checkpoint(scene);
    point->point = p;
  };
  const auto stepping = time_stepping(scene);
  const auto whole = message_of<hompm::InvalidRun>([&] { run(scene, stepping, observer); });
  REQUIRE(point);
  CHECK_FALSE(whole.empty());
  const auto read = through_bytes(*point);
  CHECK(message_of<hompm::InvalidRun>([&] { run(scene, stepping, {}, &read.point); }) == whole);
}

TEST_CASE("a checkpoint holds what the run folder is asked for") {
  auto checkpoint = hompm::first_checkpoint(built_in("bar", "small"));
  checkpoint.every = 12;
  checkpoint.vtk = false;
  checkpoint.seconds = 0.25;
  const auto read = through_bytes(checkpoint);
  CHECK(read.every == 12);
  CHECK_FALSE(read.vtk);
  CHECK(read.seconds == 0.25);
  CHECK(scene_text(read.scene) == scene_text(checkpoint.scene));
}

TEST_CASE("a damaged, truncated or foreign checkpoint is refused with its reason") {
  const auto scene = built_in("bar", "small", {{"scheme.cells", "2"}, {"end_time", "0.01"}});
  const std::string good = checkpoint_bytes(record_run(scene, 50).points.front());
  CHECK(reason(good).empty());
  SECTION("any byte damaged") {
    for (std::size_t i = 0; i < good.size(); ++i) {
      std::string bad = good;
      bad[i] = static_cast<char>(bad[i] ^ (1 << (i % 8)));
      if (!contains(reason(bad), "cannot resume from file: it ")) FAIL("byte " << i << " went through");
    }
    CHECK(contains(reason("case = \"bar\"\n"), "it is not a checkpoint of hompm"));
    CHECK(contains(reason(""), "it is not a checkpoint of hompm"));
    CHECK(contains(reason(good + "x"), "it is damaged: it is longer than it says"));
    std::string bad = good;
    bad[good.size() / 2] ^= 1;
    CHECK(contains(reason(bad), "it is damaged: its checksum does not match"));
  }
  SECTION("cut short anywhere") {
    for (std::size_t size = 1; size < good.size(); ++size)
      if (!contains(reason(good.substr(0, size)), "it is cut short")) FAIL("cut at " << size);
  }
  SECTION("of another format, version, commit or plan") {
    std::string other = good;
    other[16] = 6;
    CHECK(contains(reason(other), "it has the format 6, and this hompm reads 5"));
    const auto& build = hompm::build_info();
    const std::string commit = with_new_hash(
        replaced(good, "(" + build.commit + ")", "(" + std::string(build.commit.size(), '0') + ")"));
    CHECK(contains(reason(commit), "it was written by hompm " + build.version + " (000"));
    const std::string field = with_new_hash(replaced(good, "particles.velocity", "particles.velOcity"));
    CHECK(contains(reason(field), "it has the field particles.velOcity in place of particles.velocity"));
    const std::string cells = with_new_hash(replaced(good, "cells = 2\n", "cells = 3\n"));
    CHECK(contains(reason(cells), "does not fit its scene"));
    const std::string unknown = with_new_hash(replaced(good, "cells = 2\n", "celsl = 2\n"));
    CHECK(contains(reason(unknown), "celsl"));
  }
  SECTION("any word another, with its hash") {
    // Numbers of entries and indices are held against the scene and the size of the file: a run that goes on
    // with what is let through reads nothing outside its arrays (under the sanitizers), and takes no more
    // memory.
    const std::size_t phase = GENERATE(0U, 1U, 2U, 3U);  // texts before the numbers have any length
    for (std::size_t i = 40 + phase; i + 8 < good.size(); i += 4)
      for (const char byte : {'\xff', '\x11'}) {
        const std::string bad = with_new_hash(std::string(good).replace(i, 8, std::string(8, byte)));
        try {
          const Checkpoint read = hompm::parse_checkpoint(bad, "file");
          hompm::Simulation simulation(read.scene, 1e-4);
          simulation.state() = read.point.states.front();
          simulation.step();
        } catch (const CheckpointError&) {
        } catch (const hompm::InvalidRun&) {  // the numbers of a particle make no sense
        }
      }
    Checkpoint large = hompm::parse_checkpoint(good, "file");
    large.scene = built_in("bar", "small", {{"scheme.cells", "100000"}, {"end_time", "0.01"}});
    CHECK(contains(reason(checkpoint_bytes(large)), "the data ends too early"));
  }
}

TEST_CASE("words, bytes and hash are the documented ones on every machine") {
  hompm::detail::ByteWriter out;
  out.number(-1.5);
  out.word<2>(0x1234);
  CHECK(out.bytes == std::string("\0\0\0\0\0\0\xf8\xbf\x34\x12", 10));
  hompm::detail::ByteReader in(out.bytes);
  CHECK(in.number() == -1.5);
  CHECK(in.word<2>() == 0x1234);
  CHECK_THROWS_AS(in.word<1>(), hompm::detail::BytesEnd);

  hompm::detail::Hash hash;
  hash.add(1);
  hash.add(std::uint64_t{1} << 63U);
  CHECK(hash.value() == 16754328955608429642U);
  // A product alone would let two changed signs cancel.
  hompm::detail::Hash plus, minus;
  for (const double x : {0.0, 0.0}) plus.add(hompm::detail::word_of(x));
  for (const double x : {-0.0, -0.0}) minus.add(hompm::detail::word_of(x));
  CHECK(plus.value() != minus.value());
  CHECK(hompm::detail::hash_of_bytes("hompm") == 17677154984553623909U);
  CHECK(hompm::detail::hash_of_bytes("hompm") != hompm::detail::hash_of_bytes(std::string("hompm\0", 6)));
}
