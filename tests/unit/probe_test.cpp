// Probes: what they read, where, when, and which are refused.
#include <cmath>
#include <string>
#include <vector>

#include <hompm/kit/recorder/checkpoint.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/scenes.hpp"

namespace {

using namespace hompm;
using hompm::test::contains;
using hompm::test::message_of;

const std::string one_body = R"(end_time = 0.1
body = { length = 1.0, start = 2.0 }
material = { law = "rate", density = 1000.0, youngs_modulus = 1e5 }
ends = { left = "fixed", right = "free" }
effect = [{ type = "gravity", acceleration = -9.81 }]
scheme = { cells = 8, particles_per_cell = 2, step_fraction = 0.1 }
)";

const std::string two_bodies = R"(end_time = 0.5
material = { law = "rate", density = 1.0, youngs_modulus = 100.0 }
ends = { left = "free", right = "free" }
scheme = { particles_per_cell = 2, step_fraction = 0.1 }
[[body]]
length = 1.0
cells = 4
initial.velocity = { shape = "uniform", amplitude = 1.0 }
[[body]]
length = 1.0
start = 2.0
cells = 4
)";

Scene scene_of(const std::string& text) { return parse_scene(text, "probes.toml", {}); }

struct Told {
  std::vector<ProbeRow> rows;
  std::vector<Snapshot> snapshots;
};

Told told(const Scene& scene) {
  Told all;
  RunObserver observer;
  observer.probe = [&](const ProbeRow& row) { all.rows.push_back(row); };
  observer.snapshot = [&](const Snapshot& snapshot) { all.snapshots.push_back(snapshot); };
  run(scene, time_stepping(scene), observer);
  return all;
}

}  // namespace

TEST_CASE("a probe reads the line through the two nearest particles, at its own rate", "[probe]") {
  const Scene scene =
      scene_of(one_body +
               "output = { snapshots = 5, history = 20 }\n"
               "probe = [{ X = 2.40625, rows = 5 }, { X = 2.4375, rows = 5 }, { end = \"right\" },"
               " { x = 2.5, rows = 5 }]\n");
  const Told all = told(scene);
  REQUIRE(all.rows.size() == 3 * 6 + 21);
  std::size_t at = 0;
  for (const ProbeRow& row : all.rows) {
    if (row.probe == 2) continue;
    const Snapshot& s = all.snapshots.at(at / 3);
    ++at;
    CHECK(row.time == s.time);
    if (row.probe == 0) {  // half-way between particles 6 (X = 2.40625) and 7: on the former
      for (std::size_t column = 1; column < row.values.size(); ++column)
        CHECK(row.values[column] == (s.*detail::probe_columns[column].values)[6]);
    } else if (row.probe == 1) {
      CHECK(row.values[2] == Approx(0.5 * (s.displacement[6] + s.displacement[7])).margin(1e-17));
      CHECK(row.values[5] == Approx(0.5 * (s.stress[6] + s.stress[7])).margin(1e-12));
    } else {
      CHECK(row.values[1] == 2.5);
      CHECK(row.values[0] + row.values[2] == Approx(2.5).epsilon(1e-14));
    }
  }
  const ProbeRow end = all.rows.at(all.rows.size() - 2);  // beyond the last particle
  CHECK(end.probe == 2);
  CHECK(end.values[0] == 3.0);
  const Snapshot& last = all.snapshots.back();
  CHECK(end.values[3] == Approx(1.5 * last.velocity[15] - 0.5 * last.velocity[14]).epsilon(1e-13));
}

TEST_CASE("probes find their body, and a place in space has rows only while a body is there", "[probe]") {
  const Scene scene =
      scene_of(two_bodies +
               "[[probe]]\nx = 1.25\nrows = 4\n[[probe]]\nend = \"left\"\nbody = 1\nrows = 1\n"
               "[[probe]]\nX = 2.5\nrows = 1\n");
  std::vector<double> times;
  for (const ProbeRow& row : told(scene).rows) {
    if (row.probe == 0) {
      times.push_back(row.time);
      CHECK(row.values[0] == Approx(1.25 - row.time).epsilon(1e-12));
      CHECK(row.values[3] == Approx(1.0).epsilon(1e-12));
    }
    if (row.probe == 1) CHECK(row.values[1] == 2.0);
    if (row.probe == 2) CHECK(row.values[1] == 2.5);
  }
  // The first body's right end comes by at t = 0.25 s.
  REQUIRE(times.size() >= 2);
  CHECK(times.front() >= 0.25 - 1e-9);
}

TEST_CASE("a probe in a body of one particle reads that", "[probe]") {
  const Scene scene =
      parse_scene(one_body + "probe = [{ X = 2.25, rows = 1 }, { x = 2.25, rows = 1 }]\n", "one",
                  {{"scheme.name", "classical", "a"},
                   {"scheme.cells", "1", "b"},
                   {"scheme.particles_per_cell", "1", "c"}});
  const Told all = told(scene);
  REQUIRE(all.rows.size() == 4);
  CHECK(all.rows[2].values[3] == all.snapshots.back().velocity[0]);
}

TEST_CASE("a scene with probes is written and read as the same", "[probe]") {
  const Scene scene = scene_of(two_bodies +
                               "[[probe]]\nX = 2.5\nbody = 1\n[[probe]]\nx = -1.0\nrows = 7\n"
                               "[[probe]]\nend = \"right\"\nbody = 0\n");
  const std::string text = scene_text(scene);
  CHECK(contains(text, "\n[[probe]]\nX = 2.5  # m\nbody = 1\n\n[[probe]]\nx = -1.0  # m\nrows = 7\n"));
  CHECK(scene_text(parse_scene(text, "again", {})) == text);
  const Scene more = parse_scene(one_body, "more",
                                 {{"probe", "2.5", "--probe 2.5"},
                                  {"probe", "right", "--probe right"},
                                  {"probe", "x=7", "--probe x=7"}});
  REQUIRE(more.probes.size() == 3);
  CHECK(more.probes[0].X == 2.5);
  CHECK(more.probes[1].end == "right");
  CHECK(more.probes[2].x == 7.0);

  // And a checkpoint keeps what they told.
  Checkpoint point = first_checkpoint(more);
  point.probes = "0.25,1,1,2,3,4,5,6,7\n";
  CHECK(parse_checkpoint(checkpoint_bytes(point), "test").probes == point.probes);
}

TEST_CASE("probes that make no sense are refused where they are said", "[probe]") {
  const auto said = [](const std::string& text) { return message_of<SceneError>([&] { scene_of(text); }); };
  CHECK(contains(said(one_body + "[[probe]]\nX = 1.5\n"),
                 "probes.toml:8:5: `X` of a probe must be in a body, 2 to 3 m, not 1.5"));
  CHECK(contains(said(one_body + "[[probe]]\nX = 2.5\nend = \"left\"\n"),
                 "a probe is at exactly one of `X`, `x`, `end`, not 2"));
  CHECK(contains(said(one_body + "[[probe]]\nrows = 5\n"), "exactly one of `X`, `x`, `end`, not 0"));
  CHECK(contains(said(one_body + "[[probe]]\nend = \"lft\"\n"), "did you mean \"left\"?"));
  CHECK(contains(said(one_body + "[[probe]]\nX = 2.5\nrow = 5\n"),
                 "probes.toml:9:1: unknown key `row` of a probe; did you mean `rows`?"));
  CHECK(contains(said(one_body + "[[probe]]\nX = 2.5\nrows = 0\n"), "`rows` of a probe must be"));
  CHECK(contains(said(one_body + "[[probe]]\nX = 2.5\nbody = 1\n"), "`body` of a probe must be"));
  CHECK(contains(said(one_body + "probe = [3]\n"), "a probe must be a table, [[probe]], not 3"));
  CHECK(contains(said(one_body + "[probe]\nX = 2.5\n"), "probes are a list: write [[probe]]"));
  CHECK(contains(said(one_body + "[[prob]]\nX = 2.5\n"), "did you mean `probe`?"));
  CHECK(contains(said(two_bodies + "[[probe]]\nend = \"left\"\n"), "there are 2 bodies with a left end"));
  CHECK(contains(said(two_bodies + "[[probe]]\nX = 1.5\n"), "0 to 1 m, 2 to 3 m, not 1.5"));
  CHECK(contains(said(two_bodies + "[[probe]]\nX = 0.5\nbody = 1\n"), "in a body, 2 to 3 m, not 0.5"));
  const std::string option = message_of<SceneError>([] {
    parse_scene(one_body, "a", {{"probe", "9", "--probe 9"}});
  });
  CHECK(contains(option, "--probe 9: `X` of a probe must be in a body, 2 to 3 m, not 9"));
}
