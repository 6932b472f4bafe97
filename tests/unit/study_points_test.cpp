// What a study is made of: axes, points, their names, study files; and the run of one point.
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/kit/output/staging.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/study/measure.hpp>
#include <hompm/kit/study/outcome.hpp>
#include <hompm/kit/study/study.hpp>
#include <hompm/scheme/scheme.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/temporary_folder.hpp"

using hompm::Error;
using hompm::FileError;
using hompm::SceneError;
using hompm::test::contains;
using hompm::test::message_of;
using hompm::test::read_file;
using hompm::test::TemporaryFolder;
using hompm::test::write_file;
namespace study = hompm::study;
using study::Point;
using study::Study;

namespace {

std::vector<std::string> names_of(const std::vector<Point>& points) {
  std::vector<std::string> names;
  for (const Point& point : points) names.push_back(point.name);
  return names;
}

Study bar(std::vector<study::Sweep> sweeps, std::vector<study::Setting> settings = {}) {
  return {
      .case_name = "bar", .variant = "large", .settings = std::move(settings), .sweeps = std::move(sweeps)};
}

const study::Check no_check = [] {};

}  // namespace

TEST_CASE("a point is named by its settings, whatever the order of the axes", "[study]") {
  const Study one =
      bar({{{"scheme.cells", {"8", "16"}}, {"scheme.name", {"bspline"}}, {"scheme.courant", {"0.2"}}}});
  const Study other =
      bar({{{"scheme.courant", {"0.2"}}, {"scheme.name", {"bspline"}}, {"scheme.cells", {"8", "16"}}}});
  const std::vector<std::string> names{"scheme=bspline,cells=8,courant=0.2",
                                       "scheme=bspline,cells=16,courant=0.2"};
  CHECK(names_of(study::points_of(one)) == names);
  CHECK(names_of(study::points_of(other)) == names);
}

TEST_CASE("a point of two sweeps is one point", "[study]") {
  const Study twice = bar({{{"scheme.cells", {"8", "16"}}}, {{"scheme.cells", {"16", "32"}}}});
  CHECK(names_of(study::points_of(twice)) == std::vector<std::string>{"cells=8", "cells=16", "cells=32"});
}

TEST_CASE("a study without axes has one point", "[study]") {
  CHECK(names_of(study::points_of(bar({{}}))) == std::vector<std::string>{"as-it-is"});
}

TEST_CASE("all stands for what the table of schemes has", "[study]") {
  std::size_t expected = 0;
  std::set<std::string> all;
  for (const hompm::Scheme& scheme : hompm::scheme_table()) {
    const bool second_order = scheme.choices.time_integrator == hompm::TimeIntegrator::leapfrog;
    expected +=
        static_cast<std::size_t>(scheme.highest_degree - scheme.lowest_degree + 1) * (second_order ? 2 : 1);
    all.insert(scheme.name);
  }
  const Study study =
      bar({{{"scheme.time_integrator", {"all"}}, {"scheme.degree", {"all"}}, {"scheme.name", {"all"}}}});
  const auto points = study::checked_points(study);
  CHECK(points.size() == expected);
  for (const Point& point : points) {
    CHECK(study::scene_of(study, point).scheme.name == point.settings.front().value);
    all.erase(point.settings.front().value);
  }
  CHECK(all.empty());
  // The scheme of the study, and of the case, count as well.
  CHECK(study::points_of(bar({{{"scheme.degree", {"all"}}}}, {{"scheme.name", "high-order"}})).size() == 4);
  CHECK(study::points_of(bar({{{"scheme.degree", {"all"}}}})).size() == 5);
  CHECK(study::points_of(bar({{{"scheme.degree", {"all"}}}}, {{"scheme.name", "none"}})).empty());
}

TEST_CASE("first-order and higher-order part the table of schemes by their order in time", "[study]") {
  const auto schemes = [](const std::string& word) {
    std::vector<std::string> names;
    for (const Point& point : study::checked_points(bar({{{"scheme.name", {word}}}})))
      names.push_back(point.settings.front().value);
    return names;
  };
  std::vector<std::string> first, higher;
  for (const hompm::Scheme& scheme : hompm::scheme_table())
    (hompm::splitting(scheme.choices.time_integrator).kicks.size() == 1 ? first : higher)
        .push_back(scheme.name);
  CHECK(schemes("first-order") == first);
  CHECK(schemes("higher-order") == higher);
}

TEST_CASE("the usual sweeps hold every scheme and can be read", "[study]") {
  const Study study = bar(study::usual_sweeps());
  std::set<std::string> schemes;
  for (const Point& point : study::checked_points(study))
    schemes.insert(study::scene_of(study, point).scheme.name);
  CHECK(schemes.size() == hompm::scheme_table().size());
}

TEST_CASE("the option vary takes names with usual values, or one name with values", "[study]") {
  const auto usual = study::read_axes("scheme,particles-per-cell");
  REQUIRE(usual.size() == 2);
  CHECK(usual[0].key == "scheme.name");
  CHECK(usual[1].key == "scheme.particles_per_cell");
  CHECK(usual[1].values == std::vector<std::string>{"2", "4"});
  const auto said = study::read_axes("time-step=1e-3,0.0010,0.50");
  CHECK(said.front().key == "scheme.time_step");
  CHECK(said.front().values == std::vector<std::string>{"0.001", "0.001", "0.5"});
  CHECK(study::read_axes("effect.gravity.acceleration=-1").front().key == "effect.gravity.acceleration");
  CHECK(contains(message_of<SceneError>([] { study::read_axes("shceme"); }),
                 "--vary shceme: no scene has a key `shceme`; did you mean `scheme`?"));
  CHECK(contains(message_of<SceneError>([] { study::read_axes("cels=8"); }), "did you mean `cells`?"));
  CHECK(contains(message_of<SceneError>([] { study::read_axes("qqqqqqqqqq"); }),
                 "no scene has a key `qqqqqqqqqq`"));
  CHECK(contains(message_of<SceneError>([] { study::read_axes("material.density"); }),
                 "which values? Say --vary material.density=1,2,3"));
  CHECK(contains(message_of<SceneError>([] { study::read_axes("cells=8,,16"); }),
                 "`` is neither a number nor a word"));
  CHECK(contains(message_of<SceneError>([] { study::read_axes("scheme=../x"); }), "`../x` is neither"));
}

TEST_CASE("a value that no point can take is an error, one that some refuse is not", "[study]") {
  const auto complaint = [](const Study& study) {
    return message_of<SceneError>([&] { study::checked_points(study); });
  };
  CHECK(contains(complaint(bar({{{"scheme.name", {"bspline", "bspine"}}}})), "did you mean \"bspline\"?"));
  CHECK(contains(complaint(bar({{{"scheme.cells", {"8", "many"}}}})), "\"many\""));
  CHECK(contains(complaint(bar({}, {{"scheme.cells", "0"}})), "`scheme.cells` must be"));
  // classical has degree 1 alone, high-order from 2 on.
  const Study mixed = bar({{{"scheme.name", {"classical", "high-order"}}, {"scheme.degree", {"1", "2"}}}});
  CHECK(study::checked_points(mixed).size() == 4);
  const std::vector<std::string> many(101, "8");  // each name counts, though it is one point
  CHECK(contains(complaint(bar({{{"scheme.cells", many}, {"scheme.degree", many}}})),
                 "more than 10000 points"));
}

TEST_CASE("a study file is read with all its problems, and written back as it was", "[study]") {
  const TemporaryFolder folder;
  const auto file = (folder / "my.toml").string();
  write_file(file,
             "case = \"bar\"\nvariant = \"small\"\n[set]\nend_time = 2.0\nmaterial.density = 2\n"
             "[[sweep]]\nscheme = [\"classical\", \"bspline\"]\ncells = [8, 16]\n\"scheme.courant\" = 0.1\n"
             "[[sweep]]\nscheme = \"high-order\"\nallow_unstable = true\n");
  const Study study = study::read_study(file);
  CHECK(study::points_of(study).size() == 5);
  CHECK(study.settings == std::vector<study::Setting>{{"end_time", "2"}, {"material.density", "2"}});
  const std::string text = study::study_text(study);
  write_file(file, text);
  CHECK(study::study_text(study::read_study(file)) == text);

  write_file(file, "scene = \"a.toml\"\n");
  CHECK(study::read_study(file).scene_file == (folder / "a.toml").string());
  CHECK(study::read_study(file).sweeps.size() == study::usual_sweeps().size());

  const auto complaint = [&](const std::string& wrong) {
    write_file(file, wrong);
    return message_of<SceneError>([&] { study::read_study(file); });
  };
  const std::string many = complaint(
      "case = 1\nswep = 2\n[set]\ncels = 8\ncells = [8, 16]\n[[sweep]]\ncells = []\ndegree = 1979-05-27\n");
  for (const char* part :
       {"my.toml:1:8: `case` must be a text", "did you mean `sweep`?", "did you mean `cells`?",
        "lists go into [[sweep]]", "at least one value", "either a `case` or a `scene`"})
    CHECK(contains(many, part));
  CHECK(
      contains(complaint("case = \"bar\"\nqqqqqqq = 1"), "it holds case, variant, scene, [set], [[sweep]]"));
  CHECK(contains(complaint("case = \n"), "my.toml:1:"));
  CHECK(contains(message_of<FileError>([&] { study::read_study((folder / "none.toml").string()); }),
                 "No such file"));
  CHECK(
      contains(message_of<FileError>([&] { study::read_study(folder.path().string()); }), "it is a folder"));
}

TEST_CASE("a point is run, judged and kept, and what fails is kept, too", "[study]") {
  const study::Axis courant{"scheme.courant", {"0.2", "9"}};
  const Study study = bar({{{"scheme.name", {"high-order", "bspline"}}, {"scheme.degree", {"2"}}, courant},
                           {{"scheme.name", {"classical"}}, {"scheme.degree", {"2", "1"}}, courant}},
                          {{"scheme.cells", "8"}, {"end_time", "0.5"}});
  const auto points = study::checked_points(study);
  REQUIRE(points.size() == 8);
  const TemporaryFolder folder;
  for (const Point& point : points) {
    const auto measured = study::measure(study, point, "me", no_check);
    hompm::detail::write_whole(study::record_path(folder.path(), point.name),
                               study::record_text(measured.record));
  }
  write_file(study::times_path(folder.path(), points[0].name),
             study::times_text(
                 {points[0].name,
                  "me",
                  study::read_record(read_file(study::record_path(folder.path(), points[0].name))).scene,
                  {2.0, 1.0}}));
  const auto found = study::gather(study, points, folder.path(), "me");
  CHECK(found.missing.empty());
  REQUIRE(found.outcomes.size() == 8);
  const study::Record& fine = found.outcomes[0].record;
  CHECK(fine.status == study::Status::ok);
  CHECK(fine.work.particles == 32);
  CHECK(fine.work.mass_solves == 3 * fine.work.steps);
  REQUIRE(study::error_of(found.outcomes[0], study::Field::velocity));
  CHECK(study::error_of(found.outcomes[0], study::Field::velocity)->reference > 0.0);
  CHECK(study::cost_of(found.outcomes[0], study::Cost::seconds) == 1.0);
  CHECK_FALSE(study::cost_of(found.outcomes[0], study::Cost::instructions));
  CHECK(found.outcomes[1].record.status == study::Status::refused);
  CHECK(contains(found.outcomes[1].record.reason, "above the critical step"));
  CHECK(found.outcomes[1].record.work.steps == 1);  // as it was planned
  CHECK(found.outcomes[4].record.status == study::Status::refused);
  CHECK(found.outcomes[4].record.scene.empty());
  CHECK(contains(found.outcomes[4].record.reason, "degree"));
  // Records of another program, and of another scene, do not count.
  CHECK(study::gather(study, points, folder.path(), "you").missing.size() == 8);
  Study longer = study;
  longer.settings.back().value = "0.6";
  CHECK(study::gather(longer, points, folder.path(), "me").missing.size() == 6);
  CHECK(study::gather(study, points, folder / "elsewhere", "me").missing.size() == 8);
  CHECK(study::timed(study::measured_scene(study, points[0])) > 0.0);
}

TEST_CASE("a run that becomes invalid or has no reference is told apart", "[study]") {
  Study study = bar({{{"scheme.courant", {"2"}}}},
                    {{"scheme.cells", "8"}, {"scheme.allow_unstable", "true"}, {"end_time", "50"}});
  CHECK(study::measure(study, study::points_of(study).front(), "me", no_check).record.status ==
        study::Status::invalid);
  study = {.case_name = "column",
           .variant = "settled",
           .settings = {{"scheme.cells", "8"}, {"end_time", "0.1"}},
           .sweeps = {{}}};
  const auto unjudged = study::measure(study, study::points_of(study).front(), "me", no_check);
  CHECK(unjudged.record.status == study::Status::unjudged);
  CHECK(contains(unjudged.record.reason, "rest"));
  struct Stop {};
  const auto stopped = [&] {
    study::measure(study, study::points_of(study).front(), "me", [] { throw Stop{}; });
  };
  CHECK_THROWS_AS(stopped(), Stop);
}

TEST_CASE("instructions of a run follow from those of a few steps without overflow", "[study]") {
  const auto few = study::extrapolated(1001, 10, {.particles = 5, .steps = 1000});
  CHECK(few.total == 100100);
  CHECK(few.per_particle_and_step == 20.02);
  const std::uint64_t counted = 3'000'000'000'000ULL;
  CHECK(study::extrapolated(counted, 3, {.particles = 1, .steps = 10'000'000}).total ==
        10'000'000'000'000'000'000ULL);
}

TEST_CASE("counted instructions come back from a record", "[study]") {
  study::Record record;
  record.instructions = study::Instructions{
      .counted = 7, .counted_steps = 3, .total = 5'000'000'000'000'000'000ULL, .per_particle_and_step = 0.1};
  const auto read = study::read_record(study::record_text(record)).instructions;
  REQUIRE(read);
  CHECK(read->counted == 7);
  CHECK(read->counted_steps == 3);
  CHECK(read->total == 5'000'000'000'000'000'000ULL);
  CHECK(read->per_particle_and_step == 0.1);
}

TEST_CASE("a record that is none is refused", "[study]") {
  CHECK(contains(message_of<Error>([] { study::read_record("{"); }), "not a record"));
  CHECK(contains(message_of<Error>([] { study::read_record("{}"); }), "not a record"));
  CHECK(contains(message_of<Error>([] { study::read_times("[]"); }), "not a record"));
}

TEST_CASE("a word is made of letters, digits and signs", "[study]") {
  for (const std::string word : {"a", "z", "A", "Z", "a0", "a9", "a-b_c.d+e"})
    CHECK(study::canonical_value(word, "here") == word);
  for (const std::string other : {"", "@", "[", "`", "{", "a b", "/", ":"})
    CHECK_THROWS_AS(study::canonical_value(other, "here"), SceneError);
}

TEST_CASE("a word of a status is read back", "[study]") {
  using study::Status;
  for (const Status status : {Status::ok, Status::refused, Status::invalid, Status::unjudged}) {
    study::Record record;
    record.status = status;
    CHECK(study::read_record(study::record_text(record)).status == status);
  }
  study::Record record;
  std::string text = study::record_text(record);
  text.replace(text.find("\"ok\""), 4, "\"no\"");
  CHECK(contains(message_of<Error>([&] { study::read_record(text); }), "no status is called no"));
}
