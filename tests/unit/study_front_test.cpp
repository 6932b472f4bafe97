// Choosing among runs: the Pareto front, the cheapest, the law a front follows, and the sentences made of
// them.
#include <cmath>
#include <string>
#include <vector>

#include <hompm/kit/study/answers.hpp>
#include <hompm/kit/study/outcome.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"

using hompm::test::contains;
namespace study = hompm::study;
using study::Candidate;
using study::Cost;
using study::Field;

namespace {

/// A run of a scheme that cost `cost` instructions and made the relative error `error` in all fields.
study::Outcome outcome(const std::string& scheme, int cells, std::uint64_t cost, double error) {
  study::Outcome made;
  made.point = {
      scheme + std::to_string(cells),
      {{"scheme.name", scheme}, {"scheme.cells", std::to_string(cells)}, {"scheme.courant", "0.1"}}};
  made.record.name = made.point.name;
  made.record.scheme = scheme;
  made.record.degree = 2;
  made.record.cells = cells;
  made.record.particles_per_cell = 4;
  made.record.time_step = 0.5;
  made.record.work = {.particles = 4 * cells, .steps = 10, .force_evaluations = 10};
  const hompm::ErrorNorms norms{error, error, error};
  made.record.errors = hompm::ErrorReport{
      "a closed form", {.displacement = 1e-9, .velocity = 1e-9, .stress = 1e-9}, norms, norms, norms};
  made.record.instructions = study::extrapolated(cost, 10, made.record.work);
  return made;
}

study::Outcome failed(const std::string& scheme, int cells, study::Status status) {
  auto made = outcome(scheme, cells, 5000, 1.0);
  made.record.errors.reset();
  made.record.status = status;
  made.record.reason = "unstable, \"twice\"";
  return made;
}

/// `good` converges and is cheap, `slow` converges with order 1 at a high cost, `bad` stands still.
std::vector<study::Outcome> three_schemes() {
  return {outcome("good", 8, 1000, 1e-2),   outcome("good", 16, 4000, 1e-4), outcome("slow", 8, 10000, 1e-1),
          outcome("slow", 16, 40000, 5e-2), outcome("bad", 8, 500, 3e-1),    outcome("bad", 16, 2000, 3e-1)};
}

}  // namespace

TEST_CASE("a Pareto front holds what nothing beats, by rising cost", "[study]") {
  const std::vector<Candidate> candidates{{4.0, 0.1}, {1.0, 0.5}, {2.0, 0.6}, {3.0, 0.2},
                                          {4.0, 0.2}, {1.0, 0.5}, {9.0, 0.1}};
  CHECK(study::pareto_front(candidates) == std::vector<std::size_t>{1, 3, 0});
  CHECK(study::pareto_front({}).empty());
}

TEST_CASE("no candidate beats a member of the front, and one of the front beats every other", "[study]") {
  std::vector<Candidate> candidates;
  unsigned seed = 1;
  const auto next = [&] { return static_cast<double>((seed = seed * 1664525U + 1013904223U) >> 26U); };
  for (int i = 0; i < 200; ++i) candidates.push_back({next(), next()});
  const auto front = study::pareto_front(candidates);
  const auto beats = [&](std::size_t a, std::size_t b) {
    return candidates[a].cost <= candidates[b].cost && candidates[a].error <= candidates[b].error;
  };
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    bool member = false;
    bool beaten = false;
    for (const std::size_t f : front) {
      member = member || f == i;
      beaten = beaten || beats(f, i);
      if (f != i && beats(i, f))
        CHECK((candidates[i].cost == candidates[f].cost && candidates[i].error == candidates[f].error));
    }
    CHECK((member || beaten));
  }
}

TEST_CASE("the cheapest is the first of the front that is accurate enough", "[study]") {
  const std::vector<Candidate> candidates{{4.0, 0.1}, {1.0, 0.5}, {3.0, 0.2}};
  CHECK(study::cheapest(candidates, 0.3) == std::size_t{2});
  CHECK(study::cheapest(candidates, 0.5) == std::size_t{1});
  CHECK(study::cheapest(candidates, 0.1) == std::size_t{0});
  CHECK_FALSE(study::cheapest(candidates, 0.09));
}

TEST_CASE("numbers are brief", "[study]") {
  CHECK(study::brief(1e-4) == "1e-4");
  CHECK(study::brief(0.1) == "0.1");
  CHECK(study::brief(38.2) == "38");
  CHECK(study::brief(3.84) == "3.8");
  CHECK(study::brief(10.0) == "10");
  CHECK(study::brief(20.0) == "20");
  CHECK(study::brief(1234567.0) == "1.2e6");
  CHECK(study::brief(3.14e-12) == "3.1e-12");
  CHECK(study::brief(0.0) == "0");
}

TEST_CASE("an answer names the cheapest setting and what the others need", "[study]") {
  const auto text = study::answer(three_schemes(), Field::stress, Cost::instructions, 1e-2);
  CHECK(contains(
      text, "error 1e-2 in stress: cheapest is `good` p = 2, 8 cells × 4, courant 0.1: 1000 instructions; "));
  // Fault 17: two grids do not tell how it goes on.
  CHECK(contains(text, "`slow` does not get there in this sweep (best 5e-2)"));
  CHECK(contains(text, "`bad` does not get there in this sweep (best 0.3)"));
  const auto reached = study::answer(three_schemes(), Field::stress, Cost::instructions, 5e-2);
  CHECK(contains(reached, "`slow` needs 40 ×"));
  CHECK(contains(study::answer(three_schemes(), Field::stress, Cost::instructions, 1e-4),
                 "`slow` does not get there in this sweep"));
  CHECK(contains(study::answer(three_schemes(), Field::stress, Cost::instructions, 1e-5),
                 "nothing gets there; the best is 1e-4"));
  CHECK(contains(study::answer({}, Field::stress, Cost::instructions, 1e-5), "nothing was measured"));
}

TEST_CASE("an answer by seconds needs times, and with them others tell milliseconds", "[study]") {
  auto outcomes = three_schemes();
  CHECK(contains(study::answer(outcomes, Field::stress, Cost::seconds, 1e-2), "nothing was measured"));
  outcomes[0].seconds = {0.002, 0.0009, 0.001};
  CHECK(contains(study::answer(outcomes, Field::stress, Cost::instructions, 1e-2),
                 "1000 instructions, 0.9 ms"));
  CHECK(contains(study::answer(outcomes, Field::stress, Cost::seconds, 1e-2),
                 "9e-4 seconds; `slow` never ran"));
}

TEST_CASE("answers go down to what is reached, field by field, with a remark on reference and failures",
          "[study]") {
  auto outcomes = three_schemes();
  outcomes.push_back(failed("bad", 32, study::Status::invalid));
  const auto text = study::answers(outcomes, Cost::instructions);
  CHECK(contains(text, "error 1e-4 in velocity"));
  CHECK_FALSE(contains(text, "error 1e-5"));
  CHECK(study::remarks(outcomes) ==
        "reference: a closed form; its own error in displacement is 1e-9\n1 of 7 points: invalid: unstable, "
        "\"twice\"\n");
  outcomes.back().record.reason = "first line\nsecond";
  CHECK(contains(study::remarks(outcomes), "1 of 7 points: invalid: first line\n"));
  for (int other = 0; other < 24; ++other) {
    outcomes.push_back(failed("bad", 32, study::Status::refused));
    outcomes.back().record.reason = std::to_string(other);
  }
  CHECK(contains(study::remarks(outcomes), "\nand 5 more reasons, in points.csv\n"));
}

TEST_CASE("tables keep failed points, with their reason", "[study]") {
  auto outcomes = three_schemes();
  outcomes.push_back(failed("bad", 32, study::Status::refused));
  outcomes[1].seconds = {3.0, 1.0, 2.0};
  const auto table = study::points_csv(outcomes);
  CHECK(std::count(table.begin(), table.end(), '\n') == 8);
  CHECK(contains(
      table,
      "bad32,refused,\"unstable, \"\"twice\"\"\",bad,2,32,4,128,0.5,10,,,,,,,,,,,,,1280,10,0,0,5000,"));
  CHECK(study::times_csv(outcomes) ==
        "point,runs,least,median,largest,nanoseconds_per_particle_and_step\ngood16,3,1,2,3,1562500\n");
  const auto json = study::study_json({.case_name = "bar", .settings = {{"end_time", "2"}}}, outcomes);
  CHECK(contains(json, "\"end_time\": \"2\""));
  CHECK(contains(json, "\"status\": \"refused\""));
  CHECK_FALSE(contains(json, "program"));
}

TEST_CASE("cost falls back to particle steps where a run was not counted", "[study]") {
  auto outcomes = three_schemes();
  CHECK(study::steady_cost(outcomes) == Cost::instructions);
  outcomes[2].record.instructions.reset();
  CHECK(study::steady_cost(outcomes) == Cost::particle_steps);
  CHECK(contains(study::answers(outcomes, Cost::particle_steps), "320 particle steps"));
}

TEST_CASE("a picture draws failed points as crosses at the edge, and the reference's floor", "[study]") {
  auto outcomes = three_schemes();
  outcomes.push_back(failed("bad", 32, study::Status::invalid));
  outcomes[1].record.errors->reference_errors = {2e-4, 2e-4, 2e-4};
  const auto script = study::picture_script(outcomes, Cost::instructions, "bar", "error");
  CHECK(contains(script, "set output 'error.svg'"));
  CHECK(contains(script, "set output 'error.png'"));
  CHECK(contains(script, "set yrange [0.0001:1]"));
  CHECK(contains(script, "<< EOD\n5000 1\nEOD"));
  CHECK(contains(script, "own error of the reference"));
  // Nothing but failures, none of which has a cost.
  auto lost = failed("bad", 8, study::Status::refused);
  lost.record.instructions.reset();
  CHECK(contains(study::picture_script({lost}, Cost::instructions, "bar", "error"), "<< EOD\n1 1\nEOD"));
  // Of many schemes the most accurate are in colour.
  CHECK_FALSE(contains(script, "'others'"));
  for (const char* name : {"a", "b", "c", "d", "e", "f"})
    outcomes.push_back(outcome(name, 8, 1000, 0.001 * name[0]));
  CHECK(contains(study::picture_script(outcomes, Cost::instructions, "bar", "error"), "'others'"));
}
