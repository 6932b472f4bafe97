// Results of another code against a golden folder and the exact solution.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/verify/foreign_comparison.hpp>
#include <hompm/number.hpp>
#include <hompm/reference/reference.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/run_pair.hpp"

using namespace hompm::test;
using hompm::compare_foreign;
using hompm::ForeignComparison;
using hompm::ForeignOptions;
using hompm::Verdict;

namespace {

const fs::path golden = fs::path(HOMPM_SOURCE_DIR) / "golden/bar-small-bspline";
constexpr std::size_t particles = 256;  // in golden, at each of three times

/// A file to damage, at first the golden particles.csv:
/// time,particle,X,x,displacement,velocity,volume,density.
struct Theirs {
  TemporaryFolder folder;
  fs::path csv = folder / "theirs.csv";
  std::string text = read_file(golden / "particles.csv");

  void change_lines(const std::function<void(Lines&)>& change) {
    auto lines = split(text, '\n');
    change(lines);
    text = joined(lines, "\n");
  }
  void change_fields(const std::function<void(Lines&)>& change) {
    change_lines([&](Lines& lines) {
      for (auto& line : lines) {
        auto fields = split(line, ',');
        change(fields);
        line = joined(fields, ",");
        line.pop_back();
      }
    });
  }
  /// Line 0 is the header.
  void set(std::size_t line, std::size_t column, const std::string& value) {
    change_lines([&](Lines& lines) {
      auto fields = split(lines[line], ',');
      fields[column] = value;
      lines[line] = joined(fields, ",");
      lines[line].pop_back();
    });
  }
  ForeignComparison compare(const ForeignOptions& options = {}, const fs::path& folder_b = golden) const {
    write_file(csv, text);
    return compare_foreign(csv, folder_b, options);
  }
};

const hompm::ForeignField& figures(const ForeignComparison& result, const std::string& field, double time) {
  return *std::find_if(result.fields.begin(), result.fields.end(),
                       [&](const auto& f) { return f.field == field && f.time == time; });
}

std::uint64_t differing(const ForeignComparison& result) {
  std::uint64_t count = 0;
  for (const auto& field : result.fields) count += field.differing;
  return count;
}

}  // namespace

TEST_CASE("golden data are identical to themselves in every spelling", "[foreign]") {
  Theirs theirs;
  std::size_t notes = 0;
  SECTION("as they are") {}
  SECTION("rows in another order") {
    theirs.change_lines([](Lines& lines) { std::reverse(lines.begin() + 1, lines.end()); });
  }
  SECTION("two rows swapped") {
    theirs.change_lines([](Lines& lines) { std::swap(lines[7], lines[8]); });
  }
  SECTION("columns in another order") {
    theirs.change_fields([](Lines& fields) { std::reverse(fields.begin(), fields.end()); });
  }
  SECTION("columns nobody asked for") {
    theirs.change_fields([](Lines& fields) { fields.insert(fields.begin() + 1, "extra"); });
    notes = 1;
  }
  SECTION("CRLF") { theirs.text = joined(split(theirs.text, '\n'), "\r\n"); }
  SECTION("byte order mark") { theirs.text.insert(0, "\xef\xbb\xbf"); }
  SECTION("numpy's comment mark") { theirs.text.insert(0, "# "); }
  SECTION("blanks and plus signs") {
    theirs.change_fields([](Lines& fields) {
      for (auto& field : fields) field = " " + field + "\t";
    });
    theirs.set(1, 2, "+0.048828125");
  }
  SECTION("quoted names") {
    theirs.change_lines([](Lines& lines) {
      auto names = split(lines[0], ',');
      lines[0] = "\"" + joined(names, "\",\"");
      lines[0].resize(lines[0].size() - 2);
    });
  }
  SECTION("empty lines") {
    theirs.change_lines([](Lines& lines) { lines.insert(lines.begin() + 100, {"", " "}); });
  }
  SECTION("semicolons and decimal commas") {
    std::replace(theirs.text.begin(), theirs.text.end(), ',', ';');
    std::replace(theirs.text.begin(), theirs.text.end(), '.', ',');
  }
  SECTION("blanks") { std::replace(theirs.text.begin(), theirs.text.end(), ',', ' '); }
  SECTION("tabs") { std::replace(theirs.text.begin(), theirs.text.end(), ',', '\t'); }
  SECTION("a header with commas above rows with blanks, comments between") {
    const auto end = theirs.text.find('\n');
    std::replace(theirs.text.begin() + static_cast<std::ptrdiff_t>(end), theirs.text.end(), ',', ' ');
    theirs.text.insert(end + 1, "# a comment\n% another\n");
    theirs.text.insert(0, "# ");
  }
  SECTION("the exponents of Fortran") {
    std::replace(theirs.text.begin() + 100, theirs.text.end(), 'e', 'D');
  }
  SECTION("names by which others call the columns, in any case") {
    theirs.text.replace(0, theirs.text.find('\n'), "T,ID,X0,Pos,U,vel,Vol,RHO");
  }
  SECTION("units") {
    theirs.text.replace(
        0, theirs.text.find('\n'),
        "time [s],particle,X (m),x [m],\"displacement [m]\",velocity [m/s],volume,density [kg/m^3]");
  }
  SECTION("no end of the last line") {
    theirs.text.pop_back();
    notes = 1;
  }
  const auto result = theirs.compare();
  INFO(joined(result.messages, "\n") << joined(result.notes, "\n"));
  CHECK(result.verdict == Verdict::identical);
  CHECK(result.messages.empty());
  CHECK(result.notes.size() == notes);
  CHECK(result.fields.size() == 5 * 3);
  for (const auto& field : result.fields) {
    CHECK(field.particles == particles);
    CHECK(field.difference.max == 0.0);
  }
}

TEST_CASE("one ulp of another code is found where it is", "[foreign]") {
  const Theirs theirs;
  const auto lines = split(theirs.text, '\n');
  const auto header = split(lines[0], ',');
  for (const std::size_t line : {2U, 300U, 768U}) {
    for (std::size_t column = 3; column < header.size(); ++column) {
      Theirs changed;
      const auto fields = split(lines[line], ',');
      const double value = std::stod(fields[column]);
      changed.set(line, column, hompm::to_text(std::nextafter(value, 1e300)));
      const auto result = changed.compare();
      INFO(lines[line] << ", " << header[column]);
      CHECK(result.verdict == Verdict::different);
      CHECK(result.messages.empty());
      CHECK(differing(result) == 1);
      const auto& where = figures(result, header[column], std::stod(fields[0]));
      CHECK(where.beyond == 1);
      CHECK(where.worst_X == std::stod(fields[2]));
      CHECK(where.difference.max == std::nextafter(value, 1e300) - value);
      CHECK(changed.compare({.tolerances = {{header[column], {.ulps = 1}}}}).verdict == Verdict::equivalent);
    }
  }
}

TEST_CASE("negative zero of another code is a difference of one ulp", "[foreign]") {
  Theirs theirs;
  theirs.set(1, 4, "-0");
  const auto result = theirs.compare();
  CHECK(result.verdict == Verdict::different);
  CHECK(figures(result, "displacement", 0.0).differing == 1);
  CHECK(theirs.compare({.tolerances = {{"displacement", {.ulps = 1}}}}).verdict == Verdict::equivalent);
}

TEST_CASE("each damage of another code's file has its own message", "[foreign]") {
  struct Damage {
    std::string name;
    std::string expected;  // part of the first message
    std::function<void(Theirs&)> change;
  };
  const auto set = [](std::size_t line, std::size_t column, const std::string& value) {
    return [=](Theirs& theirs) { theirs.set(line, column, value); };
  };
  const std::vector<Damage> damages{
      {"missing row", ": the particle at X = 0.244140625 is missing at time 0",
       [](Theirs& t) { t.change_lines([](Lines& l) { l.erase(l.begin() + 3); }); }},
      {"repeated row", ": a particle with X = 0.244140625 is there twice at time 0",
       [](Theirs& t) { t.change_lines([](Lines& l) { l.insert(l.begin() + 3, l[3]); }); }},
      {"extra particle", ": B has no particle at X = 0.3 at time 0",
       [](Theirs& t) { t.change_lines([](Lines& l) { l.push_back("0,7,0.3,0.3,0,0,0,0"); }); }},
      {"displaced particle", ": the particle at X = 0.244140625 is missing at time 0", set(3, 2, "0.2443")},
      {"nan", " line 4: `nan` in column `velocity` is not finite", set(3, 5, "nan")},
      {"nan X", " line 4: `nan` in column `X` is not finite", set(3, 2, "nan")},
      {"nan time", " line 4: `nan` in column `time` is not finite", set(3, 0, "nan")},
      {"infinity", " line 4: `inf` in column `velocity` is not finite", set(3, 5, "inf")},
      {"overflow", " line 4: `1e999` in column `velocity` is beyond the range", set(3, 5, "1e999")},
      {"word", " line 4: `1.5abc` in column `velocity` is not a number", set(3, 5, "1.5abc")},
      {"two signs", " line 4: `+-1` in column `velocity` is not a number", set(3, 5, "+-1")},
      {"empty value", " line 4: `` in column `velocity` is not a number", set(3, 5, " ")},
      {"decimal comma", " line 4: 9 fields where the header has 8 (a decimal comma?): `0,2,",
       set(3, 5, "0,003")},
      {"cut row", " line 4: 2 fields where the header has 8: `0,2`",
       [](Theirs& t) { t.change_lines([](Lines& l) { l[3] = "0,2"; }); }},
      {"a time that is missing in between",
       ": time 1.25 is missing, the next ones are 0 and 2.5; --interpolate",
       [](Theirs& t) {
         t.change_lines([](Lines& l) { l.erase(l.begin() + 1 + particles, l.begin() + 1 + 2 * particles); });
       }},
      {"a last time that is missing", ": time 2.5 is missing: the file goes from 0 to 1.25; --time",
       [](Theirs& t) { t.change_lines([](Lines& l) { l.resize(1 + 2 * particles); }); }},
      {"other particles", ": none of the 1 particles at time 0 has the X of one of the 256 of B",
       [](Theirs& t) { t.text = "time,X,velocity\n0,0.1,0\n1.25,0.1,0\n2.5,0.1,0\n"; }},
  };
  const hompm::Tolerance wide{1e300, 1e300, std::numeric_limits<std::uint64_t>::max()};
  ForeignOptions lenient;
  for (const auto& field : hompm::foreign_fields()) lenient.tolerances[field] = wide;
  for (const auto& damage : damages) {
    Theirs theirs;
    damage.change(theirs);
    const auto result = theirs.compare();
    INFO(damage.name << "\n" << joined(result.messages, "\n"));
    CHECK(result.verdict == Verdict::different);
    REQUIRE_FALSE(result.messages.empty());
    CHECK(result.messages.front().starts_with(theirs.csv.string()));
    CHECK(contains(result.messages.front(), damage.expected));
    CHECK(result.messages.size() <= 4);
    CHECK(theirs.compare(lenient).verdict == Verdict::different);  // no bound excuses any of this
  }
}

TEST_CASE("what cannot be read, or compared at all, is an error that says why", "[foreign]") {
  const std::vector<std::pair<std::string, std::string>> files{
      {"time,particle,Y,velocity\n0,0,1,2\n",
       " line 1: the column `X` is missing, by which particles are matched"},
      {"tim,X,velocity\n0,1,2\n", " line 1: the column `time` is missing; --time T says"},
      {"time,X,x,x\n0,1,2,3\n", " line 1: the column `x` is there twice"},
      {"time,X,u,displacement_x\n0,1,2,3\n",
       " line 1: the columns `u` and `displacement_x` may both be the displacement: --column displacement=… "
       "says which"},
      {"time,X,disp\n0,1,2\n", " line 1: there is no column to compare; known are x, displacement"},
      {"time,X,stress [psi]\n0,1,2\n", " line 1: the unit `psi` of a column is unknown; known are m, s, "},
      {"0,1,2\n0,2,3\n", " line 1: there is no header: --column X=1"},
      {"# made on a Monday\n0 1 2\n", " line 2: there is no header"},
      {"time,X,velocity\n", ": there is no row with a readable time below the header"},
      {"", ": the file is empty"},
      {std::string("time\0\1", 6), " line 1: this is not text"},
      {"time,X,velocity\nnan,1,2\n", ": there is no row with a readable time below the header"}};
  for (const auto& [text, expected] : files) {
    Theirs theirs;
    theirs.text = text;
    INFO(message_of<hompm::FileError>([&] { theirs.compare(); }));
    CHECK(contains(message_of<hompm::FileError>([&] { theirs.compare(); }),
                   "cannot read " + theirs.csv.string() + expected));
  }
  const Theirs theirs;
  CHECK(contains(message_of<hompm::FileError>([&] {
                   theirs.compare({.columns = {{"velocity", "speed"}}});
                 }),
                 "there is no column `speed` to take for the velocity"));
}

TEST_CASE("a golden folder that is damaged is told as such", "[foreign]") {
  const Theirs theirs;
  const fs::path b = theirs.folder / "b";
  fs::create_directories(b);
  CHECK(contains(message_of<hompm::FileError>([&] { theirs.compare({}, b); }),
                 "it holds no particles.csv or stress.csv"));
  write_file(b / "particles.csv", "time;X\n");
  CHECK(contains(message_of<hompm::FileError>([&] { theirs.compare({}, b); }), "no column to compare"));
  fs::copy_file(golden / "particles.csv", b / "particles.csv", fs::copy_options::overwrite_existing);
  auto result = theirs.compare({}, b);
  CHECK(result.verdict == Verdict::identical);
  CHECK(contains(result.notes.front(), "there is no scene.toml"));
  write_file(b / "stress.csv", "time,X,stress\n0,1,0\n");
  result = theirs.compare({}, b);
  CHECK(result.verdict == Verdict::different);
  CHECK(contains(result.messages.front(), "stress.csv: times or particles are not those of particles.csv"));
  CHECK_THROWS_AS(compare_foreign(b / "missing.csv", golden, {}), hompm::FileError);
}

TEST_CASE("with bounds only fields with a bound are judged, relative to the largest value of all times",
          "[foreign]") {
  Theirs theirs;
  theirs.set(2, 5, "0");   // velocity, 0.00184 of the largest 0.1 m/s
  theirs.set(2, 7, "77");  // density
  CHECK(theirs.compare({.tolerances = {{"velocity", {.relative = 0.0185}}}}).verdict == Verdict::equivalent);
  const auto result = theirs.compare({.tolerances = {{"velocity", {.relative = 0.0184}}}});
  CHECK(result.verdict == Verdict::different);
  CHECK(figures(result, "velocity", 0.0).beyond == 1);
  CHECK(figures(result, "density", 0.0).beyond == 0);
  CHECK(figures(result, "density", 0.0).differing == 1);
  // At the start displacements are all zero: the scale is that of the other times.
  theirs.set(2, 4, "1e-4");
  CHECK(theirs.compare({.tolerances = {{"displacement", {.relative = 2e-3}}}}).verdict ==
        Verdict::equivalent);
  const auto missing =
      theirs.compare({.tolerances = {{"stress", {.relative = 1.0}}}, .required = {"stress"}});
  CHECK(missing.verdict == Verdict::different);
  CHECK(contains(missing.messages.front(), "a bound is asked for `stress`, but there is no such column"));
}

TEST_CASE("the exact solution judges at the particles of the other code", "[foreign]") {
  Theirs theirs;
  const auto scene = hompm::load_scene((golden / "scene.toml").string(), {});
  const auto reference = hompm::make_reference(scene);
  const std::vector<double> X{1.0, 7.5, 20.0};
  theirs.text = "X,time,stress,velocity,x\n";
  for (const double time : {0.0, 1.25, 2.5}) {
    const auto exact = reference->at(time, X);
    for (std::size_t p = 0; p < X.size(); ++p) {
      theirs.text += hompm::to_text(X[p]) + "," + hompm::to_text(time) + "," +
                     hompm::to_text(exact.stress[p]) + "," + hompm::to_text(exact.velocity[p]) + "," +
                     hompm::to_text(X[p] + exact.displacement[p]) + "\n";
    }
  }
  const auto result = theirs.compare();
  CHECK(result.verdict == Verdict::different);
  CHECK(contains(result.messages.front(), "none of the 3 particles"));
  CHECK(figures(result, "stress", 1.25).error->max == 0.0);
  CHECK(figures(result, "velocity", 2.5).error->max == 0.0);
  // x − X loses what the sum has rounded off: half an ulp of x = 20 m.
  CHECK(figures(result, "displacement", 1.25).error->max <= std::ldexp(1.0, -49));
  CHECK_FALSE(figures(result, "x", 1.25).error);
  CHECK(result.reference.starts_with("method of lines"));
  CHECK(result.reference_error < 1e-6);
  // Of golden, the figures are those that the run itself reported.
  CHECK(figures(result, "velocity", 2.5).golden_error->max > 1e-5);

  Theirs own;
  const auto errors = own.compare();
  const double error = figures(errors, "velocity", 1.25).error->max;
  const double other = figures(errors, "velocity", 2.5).error->max;
  const double scale = figures(errors, "velocity", 1.25).scale;
  const double bound = std::max(error, other) / scale;
  CHECK(own.compare({.exact = {{"velocity", bound * (1.0 + 1e-12)}}}).verdict == Verdict::identical);
  const auto beyond = own.compare({.exact = {{"velocity", bound * (1.0 - 1e-12)}}});
  CHECK(beyond.verdict == Verdict::different);
  CHECK(figures(beyond, "velocity", 2.5).beyond_exact);

  Theirs outside;
  outside.set(1, 2, "-0.1");
  const auto refused = outside.compare({.exact = {{"velocity", 1.0}}});
  CHECK(contains(joined(refused.messages, "\n"), "the exact velocity at time 0 is not known"));
  CHECK(contains(joined(refused.notes, "\n"), "there are particles outside of the body, 0 <= X <= 25 m"));
}

TEST_CASE("times are matched, named, interpolated or refused", "[foreign]") {
  // Cubic in time, so that the interpolation is exact but for rounding.
  const auto value = [](double t, double X) { return ((0.3 * t - 0.7) * t + 0.1) * t + X; };
  const TemporaryFolder folder;
  const fs::path b = folder / "b";
  const fs::path a = folder / "a.csv";
  const auto table = [&](const std::vector<double>& times) {
    std::string text = "time,X,velocity\n";
    for (const double t : times)
      for (const double X : {0.25, 0.75})
        text += hompm::to_text(t) + "," + hompm::to_text(X) + "," + hompm::to_text(value(t, X)) + "\n";
    return text;
  };
  write_file(b / "particles.csv", table({1.0, 2.0}));
  const auto compare = [&](const std::vector<double>& times, const ForeignOptions& options = {}) {
    write_file(a, table(times));
    return compare_foreign(a, b, options);
  };
  const ForeignOptions interpolate{.tolerances = {{"velocity", {.relative = 1e-15}}}, .interpolate = true};
  auto result = compare({0.5, 0.9, 1.25, 1.8, 2.1, 3.0}, interpolate);
  INFO(joined(result.messages, "\n") << joined(result.notes, "\n"));
  CHECK(result.verdict != Verdict::different);
  CHECK(result.notes[1] == a.string() + ": time 1 is interpolated between 0.5, 0.9, 1.25, 1.8");
  CHECK(result.notes[2] == a.string() + ": time 2 is interpolated between 1.25, 1.8, 2.1, 3");
  CHECK(compare({0.5, 0.9, 1.25, 1.8, 2.1, 3.0}).messages.size() == 2);
  // Three times give a parabola, which a cubic is not.
  CHECK(compare({0.5, 1.5, 2.5}, interpolate).verdict == Verdict::different);
  // Never beyond the last time, not even when asked.
  result = compare({0.5, 0.9, 1.25, 1.8}, interpolate);
  CHECK(result.verdict == Verdict::different);
  CHECK(contains(result.messages.front(), "time 2 is missing: the file goes from 0.5 to 1.8"));
  CHECK(compare({1.0, 2.0}).verdict == Verdict::identical);

  result = compare({1.0, 2.0 + 1e-9}, {.tolerances = {{"velocity", {.relative = 1e-8}}}});
  CHECK(result.verdict == Verdict::equivalent);
  CHECK(contains(result.notes[1], "is taken for 2"));
  CHECK(compare({1.0, 2.0 + 1e-8}, {.tolerances = {{"velocity", {.relative = 1.0}}}}).messages.size() == 1);

  CHECK(compare({2.0}, {.times = {2.0}}).verdict == Verdict::identical);
  CHECK(compare({1.0, 1.5}, {.times = {1.0, 1.0}}).fields.size() == 1);
  CHECK(message_of<hompm::OptionError>([&] { compare({2.0}, {.times = {3.0}}); }) ==
        "--time 3: B has only the times 1, 2");
  CHECK(contains(message_of<hompm::OptionError>([&] {
                   compare({2.0}, {.exact = {{"velocity", 1.0}}});
                 }),
                 "no exact solution"));

  auto text = table({1.0});
  write_file(a, "X,velocity\n0.75," + hompm::to_text(value(1.0, 0.75)) + "\n0.25," +
                    hompm::to_text(value(1.0, 0.25)) + "\n");
  CHECK(compare_foreign(a, b, {.times = {1.0}}).verdict == Verdict::identical);
  CHECK_THROWS_AS(compare_foreign(a, b, {.times = {1.0, 2.0}}), hompm::FileError);

  write_file(a, table({0.5, 0.9, 1.25, 1.8}) + "1.8,0.5,0\n");
  result = compare_foreign(a, b, {.times = {1.0}, .interpolate = true});
  CHECK(result.verdict == Verdict::different);
  CHECK(contains(result.messages.front(),
                 "time 1 cannot be interpolated: the particles at times 0.5 and 1.8 are not the same"));
}

TEST_CASE("X with few digits is matched and told", "[foreign]") {
  Theirs theirs;
  theirs.set(3, 2, "0.24414");  // of 0.244140625
  const auto result = theirs.compare();
  CHECK(result.verdict == Verdict::identical);
  CHECK(contains(result.notes.front(), "particles are matched by X to within 6.25"));
}

TEST_CASE("a column that looks like a field and is not read is no agreement", "[foreign]") {
  Theirs theirs;
  theirs.set(0, 4, "displ");
  theirs.set(0, 5, "velocty");
  auto result = theirs.compare({.tolerances = {{"density", {.relative = 1.0}}}});
  CHECK(result.verdict == Verdict::different);
  CHECK(contains(result.messages.front(),
                 "the column `displ` looks like displacement and is not read; --column displacement=displ"));
  CHECK(contains(result.messages.back(), "the column `velocty` looks like velocity"));
  CHECK(result.notes.front() == theirs.csv.string() +
                                    ": columns not looked at: `displ` (did you mean displacement?), "
                                    "`velocty` (did you mean velocity?)");
  CHECK(theirs.compare({.fields = {"density"}}).verdict == Verdict::identical);
  CHECK(theirs.compare({.columns = {{"displacement", "displ"}, {"velocity", "6"}}}).verdict ==
        Verdict::identical);
}

TEST_CASE("each field of golden that has a bound must be in the file, or follow from what is", "[foreign]") {
  ForeignOptions all;
  for (const auto& field : hompm::foreign_fields()) all.tolerances[field] = {.relative = 1.0};
  Theirs theirs;  // no stress and no stretch, which mass and law make of the density
  auto result = theirs.compare(all);
  CHECK(result.verdict == Verdict::identical);
  CHECK(result.not_compared == std::vector<std::string>{"stress", "stretch"});
  theirs.change_fields([](Lines& fields) { fields.resize(6); });
  result = theirs.compare(all);
  CHECK(result.verdict == Verdict::different);
  CHECK(contains(result.messages.front(),
                 "a bound is asked for `volume`, but there is no such column; --fields"));
  all.fields = {"displacement", "velocity"};
  CHECK(theirs.compare(all).verdict == Verdict::identical);
  all.fields = {"stress"};
  result = theirs.compare(all);
  CHECK(contains(result.messages.front(), "but there is no such column"));
}

TEST_CASE("a body that comes to rest is compared when it has", "[foreign]") {
  const fs::path settled = fs::path(HOMPM_SOURCE_DIR) / "golden/column-settled-high-order";
  const Theirs theirs;
  write_file(theirs.csv, read_file(settled / "stress.csv"));
  auto result = compare_foreign(theirs.csv, settled, {});
  CHECK(result.verdict == Verdict::identical);
  CHECK(result.fields.size() == 4);
  CHECK(figures(result, "stress", result.fields[0].time).error);
  CHECK(contains(result.notes.front(), "A is taken to be at rest at its last time"));
  // The time at which it rests is no result.
  auto lines = split(read_file(settled / "stress.csv"), '\n');
  for (auto& line : lines) {
    if (line.starts_with(lines.back().substr(0, lines.back().find(','))))
      line.replace(0, line.find(','), "77");
  }
  write_file(theirs.csv, joined(lines, "\n"));
  CHECK(compare_foreign(theirs.csv, settled, {}).verdict == Verdict::identical);

  const fs::path restless = fs::path(HOMPM_SOURCE_DIR) / "golden/column-settled-classical";
  result = compare_foreign(restless / "stress.csv", restless, {});
  CHECK(contains(result.notes.front(), "which is not at rest"));
  CHECK_FALSE(figures(result, "stress", result.fields[0].time).golden_error);
}

TEST_CASE("a particle a thousandth of a spacing away is another particle", "[foreign]") {
  Theirs theirs;
  theirs.set(3, 2, "0.2442871");  // 1.5e-3 spacings of 25/256 m from 0.244140625
  const auto result = theirs.compare();
  CHECK(result.verdict == Verdict::different);
  CHECK(contains(joined(result.messages, "\n"), "B has no particle at X = 0.2442871"));
}

TEST_CASE("a column that is meant is named only where it is not there", "[foreign]") {
  Theirs theirs;
  theirs.change_lines([](Lines& lines) {
    for (auto& line : lines) line += &line == &lines.front() ? ",Velocity,qqqqqqqq,\"" : ",0,0,0";
  });
  CHECK(theirs.compare().notes.front() ==
        theirs.csv.string() + ": columns not looked at: `Velocity`, `qqqqqqqq`, `\"`");
}

TEST_CASE("particles on another grid are judged by the exact solution alone", "[foreign]") {
  Theirs theirs;
  theirs.change_fields([](Lines& fields) {
    if (fields[2] != "X") fields[2] = hompm::to_text(std::stod(fields[2]) + 1e-3);
  });
  const auto result = theirs.compare({.exact = {{"velocity", 0.1}}});
  CHECK(result.verdict == Verdict::equivalent);
  CHECK(contains(joined(result.notes, "\n"),
                 "none of the 256 particles at time 0 has the X of one of the 256 of B"));
  CHECK(theirs.compare({.tolerances = {{"velocity", {.relative = 1.0}}}}).verdict == Verdict::different);
  CHECK(theirs.compare({.exact = {{"velocity", 1e-9}}}).verdict == Verdict::different);

  // A case, or a scene file, in the place of the folder.
  for (const fs::path& b : {fs::path("bar-small"), golden / "scene.toml"}) {
    const auto alone = theirs.compare({.exact = {{"velocity", 0.1}}}, b);
    CHECK(alone.verdict == Verdict::equivalent);
    CHECK(alone.fields.size() == 2 * 3);  // displacement and velocity, at three times
    CHECK(alone.fields.front().particles == 0);
    CHECK(theirs.compare({.exact = {{"velocity", 1e-9}}}, b).verdict == Verdict::different);
    // At 2.5 s the bar is nearly where it began: the scale is that of all times.
    const auto last = theirs.compare({.exact = {{"displacement", 0.1}}, .times = {2.5}}, b);
    CHECK(last.verdict == Verdict::equivalent);
    CHECK(last.fields.front().scale > 0.07);
    CHECK_THROWS_AS(theirs.compare({.times = {7.0}}, b), hompm::OptionError);
  }
  CHECK(contains(message_of<hompm::FileError>([&] { theirs.compare({}, "bar-smal"); }),
                 "the built-in cases are bar-"));
  CHECK(contains(message_of<hompm::FileError>([&] { theirs.compare({}, theirs.csv); }), "nor a scene file"));
}

TEST_CASE("of many times the exact solution judges twenty", "[foreign]") {
  Theirs theirs;
  theirs.text = "time,X,displacement\n";
  for (int i = 0; i < 30; ++i) theirs.text += hompm::to_text(0.05 * i) + ",12.5,0\n";
  const auto result = theirs.compare({}, "bar-small");
  CHECK(result.fields.size() == 20);
  CHECK(result.fields.back().time == 0.05 * 29);
  theirs.text = "time,X,density\n0,12.5,1\n";
  const auto nothing = theirs.compare({}, "bar-small");
  CHECK(nothing.verdict == Verdict::different);
  CHECK(nothing.messages == std::vector<std::string>{"nothing could be compared"});
}

TEST_CASE("a file that ends a little early is compared where it has data", "[foreign]") {
  Theirs theirs;
  const auto relabel = [&](const std::string& last) {
    theirs.change_fields([&](Lines& fields) {
      if (fields[0] == "2.5") fields[0] = last;
    });
  };
  relabel("2.4999");
  auto result = theirs.compare();
  CHECK(result.verdict == Verdict::equivalent);  // not all of it was compared
  CHECK(contains(result.notes.front(), "time 2.5 is not compared: A ends before it, at 2.4999"));
  CHECK(theirs.compare({.time_tolerance = 1e-3}).verdict == Verdict::identical);
  CHECK(theirs.compare({.times = {2.5}, .time_tolerance = 1e-5}).verdict == Verdict::different);
}

TEST_CASE("X may follow from other columns, and strips are averaged", "[foreign]") {
  Theirs theirs;
  SECTION("from x and displacement") {
    theirs.set(0, 2, "other");
    CHECK(theirs.compare({.tolerances = {{"velocity", {.ulps = 1}}}}).verdict != Verdict::different);
  }
  SECTION("from the particle's number and the first time") {
    theirs.change_fields([](Lines& fields) { fields = {fields[0], fields[1], fields[3], fields[5]}; });
    CHECK(theirs.compare().verdict == Verdict::identical);
    theirs.text += "2.5,777,1,1\n";
    CHECK(contains(theirs.compare().messages.front(), "particle 777 is not there at the first time"));
  }
  SECTION("of a strip") {
    const auto lines = split(theirs.text, '\n');
    for (std::size_t i = 1; i < lines.size(); ++i) theirs.text += lines[i] + "\n";
    auto result = theirs.compare();
    CHECK(result.verdict == Verdict::identical);
    CHECK(contains(result.notes.front(),
                   "512 rows at time 0 are averaged over those of the same X, 256 of them; they lie apart by "
                   "up to x 0, displacement 0"));
    auto fields = split(lines[1], ',');
    theirs.set(1, 5, hompm::to_text(std::stod(fields[5]) + 1e-3));
    result = theirs.compare();
    CHECK(std::abs(figures(result, "velocity", 0.0).difference.max - 0.5e-3) < 1e-15);
    CHECK(contains(result.notes.front(), "velocity 0.001"));
  }
  SECTION("in another direction") {
    theirs.text.replace(0, theirs.text.find('\n'), "t,id,Y,y,uy,v2,vol,rho");
    CHECK(theirs.compare({.direction = 'y'}).verdict == Verdict::identical);
    CHECK_THROWS_AS(theirs.compare(), hompm::FileError);
  }
}

TEST_CASE("mistakes are named", "[foreign]") {
  struct Mistake {
    std::string hint;
    std::function<void(Lines&)>
        change;  // of fields: time, particle, X, x, displacement, velocity, volume, density
  };
  const auto times = [](std::size_t column, double factor) {
    return [=](Lines& fields) { fields[column] = hompm::to_text(std::stod(fields[column]) * factor); };
  };
  const std::vector<Mistake> all{
      {"displacement: A is 1000 × B: millimetres?", times(4, 1e3)},
      {"velocity: A is 1000 × B: mm/s?", times(5, 1e3)},
      {"density: A is 0.001 × B: g/cm³?", times(7, 1e-3)},
      {"velocity: A is −1 × B: the axis the other way round?", times(5, -1.0)},
      {"time: A is 1000 × B: milliseconds?", times(0, 1e3)},
      {"X: A is 1000 × B: millimetres?", times(2, 1e3)},
      {"displacement of A is X + that of B: is it x?", [](Lines& f) { f[4] = f[3]; }},
      {"x of A is that of B without X: is it the displacement?", [](Lines& f) { f[3] = f[4]; }},
      {"displacement, velocity of A are 1.25 × those of B: another amplitude or load?",
       [&](Lines& f) {
         times(4, 1.25)(f);
         times(5, 1.25)(f);
       }},
      {"all values of A fit in single precision",
       [](Lines& f) {
         for (std::size_t c = 3; c < 8; ++c)
           f[c] = hompm::to_text(static_cast<double>(static_cast<float>(std::stod(f[c]))));
       }},
      {"A lacks 1 of 256 particles, all at the right end",
       [](Lines& f) {
         if (std::stod(f[2]) > 24.9) f = {""};
       }},
      {"A has 128 particles, B 64 cells × 4: 2 in a cell?",
       [](Lines& f) {
         f[2] = hompm::to_text(std::stod(f[2]) + 0.01);
         if (std::stoi(f[1]) % 2 == 0) f = {""};
       }},
      {"A is 0.001 s, ahead: are its times those of another step?",
       [](Lines& f) { f[4] = hompm::to_text(std::stod(f[4]) + 1e-3 * std::stod(f[5])); }},
      {"velocity of A is half a step ahead",  // of a standing wave: acceleration is -(pi c / L)^2 u
       [](Lines& f) { f[5] = hompm::to_text(std::stod(f[5]) - 0.5e-4 * 1.579 * std::stod(f[4])); }},
      {"A is one step, 1e-04 s, ahead: are its times those of another step?",
       [](Lines& f) { f[4] = hompm::to_text(std::stod(f[4]) + 1e-4 * std::stod(f[5])); }},
  };
  for (const auto& [hint, change] : all) {
    Theirs theirs;
    theirs.change_lines([&change = change](Lines& lines) {
      for (std::size_t i = 1; i < lines.size(); ++i) {
        auto fields = split(lines[i], ',');
        change(fields);
        lines[i] = joined(fields, ",");
        lines[i].pop_back();
      }
    });
    const auto result = theirs.compare();
    INFO(hint << "\n" << joined(result.hints, "\n"));
    CHECK(result.verdict == Verdict::different);
    REQUIRE_FALSE(result.hints.empty());
    CHECK(std::any_of(result.hints.begin(), result.hints.end(),
                      [&text = hint](const auto& h) { return contains(h, text); }));
  }
}
