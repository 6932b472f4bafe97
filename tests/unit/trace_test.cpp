// The flight recorder: one bit changed in one stage of one step is what it finds, and nothing else.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>

#include <hompm/error.hpp>
#include <hompm/kit/recorder/bytes.hpp>
#include <hompm/kit/recorder/trace.hpp>
#include <hompm/kit/recorder/trace_file.hpp>
#include <hompm/scheme/scheme.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/file_size_limit.hpp"
#include "support/message_of.hpp"
#include "support/recorded_run.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using namespace hompm::test;
using hompm::Phase;
using hompm::Plan;
using hompm::State;

namespace {

/// Runs with a trace; `change` may alter the plan before.
void write_trace(
    const hompm::Scene& scene, const fs::path& path, const std::function<void(Plan&)>& change = [](Plan&) {},
    hompm::TraceOptions options = {}, const hompm::RunPoint* from = nullptr) {
  hompm::Trace trace(path, options);
  hompm::RunObserver observer;
  observer.start = [&](hompm::Simulation& simulation) {
    change(simulation.plan());
    trace.attach(scene, simulation);
  };
  hompm::run(scene, time_stepping(scene), observer, from);
  trace.close();
}

/// A change of the plan: in step `step`, part `part`, the stage whose name begins with `name` also does
/// `damage`.
std::function<void(Plan&)> in_stage(const std::string& name, std::int64_t step, int part,
                                    const std::function<void(State&)>& damage) {
  return [=](Plan& plan) {
    for (auto& phase : plan.phases)
      for (auto& stage : phase) {
        if (!stage.name.starts_with(name)) continue;
        stage.run = [=, run = stage.run, parts = 0](State& state) mutable {
          run(state);
          if (state.step == step && ++parts == part) damage(state);
        };
        return;
      }
    FAIL("no stage " << name);
  };
}

double flipped(double value, int bit) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^ (std::uint64_t{1} << bit));
}

}  // namespace

TEST_CASE("equal runs have equal traces, whatever they report and when") {
  const TemporaryFolder scratch;
  const auto& scheme = GENERATE(from_range(hompm::scheme_table()));
  const std::string kinematics = GENERATE("finite", "infinitesimal");
  auto scene = busy_scene(scheme.name, scheme.default_degree, "leapfrog", kinematics);
  write_trace(scene, scratch / "a");
  write_trace(scene, scratch / "b");
  CHECK((read_file(scratch / "a") == read_file(scratch / "b")));
  scene.output.history = 60;  // with leapfrog each row computes a step of its own to the full step
  write_trace(scene, scratch / "b");
  const auto found = hompm::compare_traces(scratch / "a", scratch / "b");
  CHECK(found.identical);
  CHECK(found.first_step == 0);
  CHECK(found.last_step == 60);
  CHECK(found.notes ==
        std::vector<std::string>{"the scenes differ: `history = 9` in A, `history = 60` in B"});
}

TEST_CASE("a trace changes no bit of the run") {
  const TemporaryFolder scratch;
  const auto scene = busy_scene("high-order", 3, "blanes-moan", "finite");
  hompm::Trace trace(scratch / "trace");
  hompm::RunObserver observer;
  observer.start = [&](hompm::Simulation& simulation) { trace.attach(scene, simulation); };
  const auto traced = run(scene, time_stepping(scene), observer);
  const auto plain = run(scene, time_stepping(scene));
  CHECK(traced.final.stress == plain.final.stress);
  CHECK(traced.final.velocity == plain.final.velocity);
  CHECK(traced.end.residual == plain.end.residual);
}

TEST_CASE("one flipped bit is found: step, part, stage, field, particle, values and distance") {
  struct Flip {
    std::string scheme, integrator, stage;
    std::int64_t step;
    int part, bit;
    std::function<double&(State&)> value;
    std::string field, place;
  };
  const auto& flip = GENERATE(values<Flip>({
      {"tielen2017", "euler-cromer", "particle velocity (FLIP)", 7, 1, 0,
       [](State& s) -> double& { return s.particles.velocity[12]; }, "particles.velocity", "particle 12"},
      {"tielen2017", "euler-cromer", "internal force from", 60, 1, 51,
       [](State& s) -> double& { return s.fields.internal_force[3]; }, "grid.internal_force",
       "grid function 3"},
      {"bspline", "leapfrog", "gravity", 1, 1, 63, [](State& s) -> double& { return s.balance.impulse; },
       "balance.impulse", ""},
      {"bspline", "euler-cromer", "basis at the particles", 30, 1, 1,
       [](State& s) -> double& { return s.basis.gradients[3 * 31 + 2]; }, "basis.gradients",
       "particle 31, function 2 there"},
      {"high-order", "blanes-moan", "displacement", 33, 4, 3,
       [](State& s) -> double& { return s.particles.displacement[5]; }, "particles.displacement",
       "particle 4"},
      {"high-order", "blanes-moan", "displacement", 33, 6, 3,
       [](State& s) -> double& { return s.particles.displacement[33]; }, "particles.displacement",
       "the marker at the right end"},
      // a field that the stage does not touch by itself
      {"classical", "euler-cromer", "particle velocity (FLIP)", 9, 1, 20,
       [](State& s) -> double& { return s.particles.mass[0]; }, "particles.mass", "particle 0"},
  }));
  const TemporaryFolder scratch;
  const int degree = hompm::find_scheme(flip.scheme).default_degree;
  const auto scene = busy_scene(flip.scheme, degree, flip.integrator, "finite");
  double before = 0.0;
  double after = 0.0;
  write_trace(scene, scratch / "a");
  write_trace(scene, scratch / "b", in_stage(flip.stage, flip.step, flip.part, [&](State& state) {
                double& value = flip.value(state);
                before = value;
                after = value = flipped(value, flip.bit);
              }));
  const auto found = hompm::compare_traces(scratch / "a", scratch / "b");
  INFO(flip.scheme << ", " << flip.stage << ", " << flip.field);
  CHECK_FALSE(found.identical);
  REQUIRE(found.first);
  CHECK(found.first->step == flip.step);
  CHECK(found.first->part == flip.part);
  CHECK(found.first->stage.starts_with(flip.stage));
  CHECK(found.first->field == flip.field);
  REQUIRE(found.first->values);
  const auto& values = *found.first->values;
  CHECK(values.place == flip.place);
  CHECK(values.a == std::bit_cast<std::uint64_t>(before));
  CHECK(values.b == std::bit_cast<std::uint64_t>(after));
  CHECK(std::stod(values.text_a) == before);
  CHECK(std::stod(values.text_b) == after);
  if (flip.bit < 52) CHECK(values.distance == std::uint64_t{1} << flip.bit);
  CHECK(values.differing == 1);
}

TEST_CASE("where the values are not in the traces, it says so, and finds them when they are asked for") {
  const TemporaryFolder scratch;
  const auto scene = busy_scene("bspline", 2, "euler-cromer", "finite");
  const auto flip = in_stage("out-of-balance force", 40, 1,
                             [](State& s) { s.fields.force[4] = flipped(s.fields.force[4], 0); });
  const auto compared = [&](hompm::TraceOptions a, hompm::TraceOptions b) {
    write_trace(
        scene, scratch / "a", [](Plan&) {}, a);
    write_trace(scene, scratch / "b", flip, b);
    return *hompm::compare_traces(scratch / "a", scratch / "b").first;
  };
  const hompm::TraceOptions few{.values_from = 0, .values_bytes = 1000};
  const hompm::TraceOptions asked{.values_from = 40, .values_bytes = 1};
  const auto without = compared(few, few);
  CHECK(without.step == 40);
  CHECK(without.field == "grid.force");
  CHECK_FALSE(without.values);
  CHECK(without.missing_in == "A and B");
  CHECK(compared(few, asked).missing_in == "A");
  CHECK(compared(asked, few).missing_in == "B");
  const auto with = compared(asked, asked);
  REQUIRE(with.values);
  CHECK(with.values->place == "grid function 4");
  CHECK(with.values->distance == 1);
}

TEST_CASE("the trace of a resumed run continues that of the whole one") {
  const TemporaryFolder scratch;
  const auto scene = busy_scene("high-order", 3, "leapfrog", "finite");
  const auto points = record_run(scene, 25).points;
  write_trace(scene, scratch / "whole");
  write_trace(
      scene, scratch / "rest", [](Plan&) {}, {}, &points[1].point);
  const auto found = hompm::compare_traces(scratch / "whole", scratch / "rest");
  CHECK(found.identical);
  CHECK(found.first_step == 50);
  CHECK(found.last_step == 60);
  auto other = points[1].point;
  other.states.front().particles.stress[1] = 1.0;
  write_trace(
      scene, scratch / "rest", [](Plan&) {}, {}, &other);
  for (const bool swapped : {false, true}) {
    const auto difference =
        hompm::compare_traces(scratch / (swapped ? "rest" : "whole"), scratch / (swapped ? "whole" : "rest"));
    REQUIRE(difference.first);
    CHECK(difference.first->step == 50);
    CHECK(difference.first->field == "particles.stress");
    REQUIRE(difference.first->values);
    CHECK(difference.first->values->place == "particle 0");
  }
}

TEST_CASE("a trace that ends before the other begins is a difference, and says so") {
  const TemporaryFolder scratch;
  auto scene = busy_scene("bspline", 2, "leapfrog", "finite");
  const auto points = record_run(scene, 50).points;
  write_trace(
      scene, scratch / "late", [](Plan&) {}, {}, &points.front().point);
  scene.end_time = 0.02;
  write_trace(scene, scratch / "early");
  const auto messages = [&](const char* a, const char* b) {
    const auto found = hompm::compare_traces(scratch / a, scratch / b);
    CHECK_FALSE(found.identical);
    CHECK_FALSE(found.first);
    return found.messages;
  };
  CHECK(messages("early", "late") ==
        std::vector<std::string>{"A ends at step 20, before the other begins at step 50"});
  CHECK(messages("late", "early") ==
        std::vector<std::string>{"B ends at step 20, before the other begins at step 50"});
}

TEST_CASE("traces of other plans, states and lengths differ, and say how") {
  const TemporaryFolder scratch;
  const auto trace_of = [&](const char* name,
                            std::initializer_list<std::pair<std::string, std::string>> keys) {
    write_trace(built_in("bar", "small", keys), scratch / name);
  };
  trace_of("a", {{"scheme.cells", "4"}, {"end_time", "0.01"}});
  const auto messages = [&] {
    const auto found = hompm::compare_traces(scratch / "a", scratch / "b");
    CHECK_FALSE(found.identical);
    CHECK_FALSE(found.first);
    REQUIRE(found.messages.size() == 1);
    return found.messages.front();
  };
  trace_of("b", {{"scheme.cells", "4"}, {"end_time", "0.01"}, {"scheme.name", "bspline"}});
  CHECK_THAT(messages(), contains("the plans differ: stage "));
  trace_of("b", {{"scheme.cells", "5"}, {"end_time", "0.01"}});
  CHECK_THAT(messages(),
             contains("the states differ: field 11 is particles.reference_position with 16 values "
                      "in A and particles.reference_position with 20 values in B"));
  trace_of("b", {{"scheme.cells", "4"}, {"end_time", "0.02"}});
  CHECK_THAT(messages(), contains("A ends at step") && contains("up to there they are the same"));
}

TEST_CASE("a trace cut off anywhere is read as far as it goes, a damaged one is refused") {
  const TemporaryFolder scratch;
  const auto scene =
      built_in("bar", "small", {{"scheme.cells", "1"}, {"scheme.name", "bspline"}, {"end_time", "0.003"}});
  write_trace(scene, scratch / "good", [](Plan&) {}, {.values_from = 0, .values_bytes = 1});
  const std::string good = read_file(scratch / "good");
  const auto compare = [&](const std::string& bytes) {
    write_file(scratch / "bad", bytes);
    return hompm::compare_traces(scratch / "good", scratch / "bad");
  };
  CHECK(compare(good).identical);
  for (std::size_t size = 0; size < good.size(); size += size + 40 < good.size() ? 3 : 1) {
    std::string message;
    hompm::TraceComparison found;
    message = message_of<hompm::FileError>([&] { found = compare(good.substr(0, size)); });
    if (message.empty()) {
      const bool noted = !found.notes.empty() && contains(found.notes.back(), "B has no end");
      if (found.first || !noted) FAIL("cut at " << size);
    } else if (!contains(message, "is not a trace") &&
               !contains(message, "cut short before the first step")) {
      FAIL("cut at " << size << ": " << message);
    }
  }
  for (std::size_t i = 0; i + 10 < good.size(); i += 3) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ (1 << (i % 8)));
    if (message_of<hompm::FileError>([&] { compare(bad); }).empty()) FAIL("byte " << i << " went through");
  }
  // A trace without its end has no hash: what its head says is held against itself.
  const std::string open = good.substr(0, good.size() - 10);
  for (std::size_t i = 16; i + 8 < std::min<std::size_t>(open.size(), 6000); i += 2)
    for (const char byte : {'\xff', '\x11', '\0'}) {
      write_file(scratch / "bad", std::string(open).replace(i, 8, std::string(8, byte)));
      for (const char* other : {"good", "bad"}) {
        try {
          hompm::compare_traces(scratch / "bad", scratch / other);
        } catch (const hompm::FileError&) {  // and no other error
        }
      }
    }
  CHECK_THROWS_AS(hompm::compare_traces(scratch / "good", scratch / "none"), hompm::FileError);
  hompm::detail::ByteWriter other;
  other.bytes = hompm::detail::trace_magic;
  other.word(hompm::detail::trace_format + 1);
  CHECK_THAT(message_of<hompm::FileError>([&] { compare(other.bytes); }),
             contains("the trace has the format 3"));
}

TEST_CASE("the trace of several bodies holds all of them, and changes no bit of their run") {
  const TemporaryFolder scratch;
  const auto scene = colliding_bars(GENERATE(as<std::string>{}, "euler-cromer", "leapfrog"));
  const auto points = record_run(scene, 10).points;
  write_trace(scene, scratch / "a");
  write_trace(scene, scratch / "b");
  CHECK((read_file(scratch / "a") == read_file(scratch / "b")));
  write_trace(
      scene, scratch / "b", [](Plan&) {}, {}, &points[1].point);
  const auto found = hompm::compare_traces(scratch / "a", scratch / "b");
  CHECK(found.identical);
  CHECK(found.first_step == 20);
  CHECK(found.last_step == 30);

  hompm::Trace trace(scratch / "trace");
  hompm::RunObserver observer;
  observer.start = [&](hompm::Simulation& simulation) { trace.attach(scene, simulation); };
  const auto traced = run(scene, time_stepping(scene), observer);
  const auto plain = run(scene, time_stepping(scene));
  CHECK(traced.final.velocity == plain.final.velocity);
  CHECK(traced.end.residual == plain.end.residual);
}

TEST_CASE("one flipped bit of one body is found, in its own stages and between the bodies") {
  struct Flip {
    std::size_t body;  ///< 2: the coupling
    std::string stage;
    std::function<double&(State&)> value;
    std::string named, field, place;
    std::size_t named_body;
  };
  const auto& flip = GENERATE(values<Flip>({
      {0, "displacement", [](State& s) -> double& { return s.particles.displacement[5]; },
       "displacement of body 0", "particles.displacement", "particle 4", 0},
      {1, "displacement", [](State& s) -> double& { return s.particles.displacement[5]; },
       "displacement of body 1", "particles.displacement", "particle 36", 1},
      {1, "gravity", [](State& s) -> double& { return s.fields.force[3]; }, "gravity of body 1", "grid.force",
       "grid function 3", 1},
      {1, "basis at the particles", [](State& s) -> double& { return s.basis.values[4 * 41 + 1]; },
       "basis at the particles of body 1", "basis.values", "the marker at the right end, function 1 there",
       1},
      {2, "contact", [](State& s) -> double& { return s.particles.velocity[0]; }, "contact of bodies 0 and 1",
       "particles.velocity", "the marker at the left end", 1},
  }));
  const TemporaryFolder scratch;
  const auto scene = colliding_bars("euler-cromer");
  double before = 0.0;
  const auto damage = [&](State& state) {
    double& value = flip.value(state);
    before = value;
    value = flipped(value, 2);
  };
  const auto traced = [&](const char* name, bool damaged) {
    hompm::Trace trace(scratch / name);
    hompm::RunObserver observer;
    observer.start = [&](hompm::Simulation& simulation) {
      if (damaged && flip.body < 2) in_stage(flip.stage, 17, 1, damage)(simulation.plan(flip.body));
      if (damaged && flip.body == 2)
        for (auto& coupling : simulation.couplings()) {
          if (coupling.name != flip.stage) continue;
          coupling.run = [&damage, run = coupling.run](State& left, State& right) {
            run(left, right);
            if (right.step == 17) damage(right);
          };
        }
      trace.attach(scene, simulation);
    };
    hompm::run(scene, time_stepping(scene), observer);
    trace.close();
  };
  traced("a", false);
  traced("b", true);
  const auto found = hompm::compare_traces(scratch / "a", scratch / "b");
  CAPTURE(flip.named, flip.field);
  REQUIRE(found.first);
  CHECK(found.first->step == 17);
  CHECK(found.first->stage == flip.named);
  CHECK(found.first->field == flip.field);
  CHECK(found.first->body == flip.named_body);
  REQUIRE(found.first->values);
  CHECK(found.first->values->place == flip.place);
  CHECK(found.first->values->a == std::bit_cast<std::uint64_t>(before));
  CHECK(found.first->values->distance == 4);
  CHECK(found.first->values->differing == 1);
}

TEST_CASE("a trace that cannot be written stops the run; one of a run that fails is whole") {
  const TemporaryFolder scratch;
  const auto scene = busy_scene("bspline", 2, "euler-cromer", "finite");
  {
    const FileSizeLimit full(100000);
    CHECK_THAT(message_of<hompm::FileError>([&] { write_trace(scene, scratch / "full"); }),
               contains("File too large"));
  }
  CHECK_THROWS_AS(write_trace(scene, scratch / "no/folder"), hompm::FileError);

  const auto unstable = built_in(
      "bar", "large", {{"scheme.allow_unstable", "true"}, {"scheme.time_step", "0.07"}, {"end_time", "50"}});
  CHECK_THROWS_AS(write_trace(unstable, scratch / "a"), hompm::InvalidRun);
  CHECK_THROWS_AS(write_trace(unstable, scratch / "b"), hompm::InvalidRun);
  const auto found = hompm::compare_traces(scratch / "a", scratch / "b");
  CHECK(found.identical);
  CHECK(found.notes.empty());
}
