#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <hompm/kit/verify/compare.hpp>
#include <hompm/number.hpp>

#include "support/catch.hpp"
#include "support/run_pair.hpp"

using namespace hompm::test;
using hompm::compare_folders;
using hompm::Comparison;
using hompm::Verdict;

namespace {

double next_up(double value) { return std::nextafter(value, std::numeric_limits<double>::infinity()); }

}  // namespace

TEST_CASE("ulp distance counts the doubles between two values", "[compare]") {
  using hompm::ulp_distance;
  const double tiny = std::numeric_limits<double>::denorm_min();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(ulp_distance(1.5, 1.5) == 0);
  CHECK(ulp_distance(1.0, next_up(1.0)) == 1);
  CHECK(ulp_distance(-1.0, next_up(-1.0)) == 1);
  CHECK(ulp_distance(1.0, 2.0) == std::uint64_t{1} << 52);
  CHECK(ulp_distance(0.0, -0.0) == 1);
  CHECK(ulp_distance(-tiny, tiny) == 3);
  CHECK(ulp_distance(nan, 1.0) == std::numeric_limits<std::uint64_t>::max());
  CHECK(ulp_distance(nan, nan) == std::numeric_limits<std::uint64_t>::max());
}

TEST_CASE("equal folders are identical", "[compare]") {
  const Pair pair;
  const auto result = pair.compare();
  CHECK(result.verdict == Verdict::identical);
  CHECK(result.messages.empty());
  CHECK(result.notes.empty());
  CHECK_FALSE(result.first);
  REQUIRE(result.fields.size() == 6 + 4 + 11);
  for (const auto& field : result.fields) {
    CHECK(field.values == (field.file == "history.csv" ? 3 : 15));
    CHECK(field.differing == 0);
  }
  CHECK(compare_folders(pair.a, pair.a, {}).verdict == Verdict::identical);
}

TEST_CASE("one ulp in any value of any file is found where it is", "[compare]") {
  const Pair pair;
  for (const std::string file : {"particles.csv", "stress.csv", "history.csv"}) {
    const bool has_particles = file != "history.csv";
    const auto original = read_file(pair.a / file);
    const auto lines = split(original, '\n');
    const auto header = split(lines[0], ',');
    for (std::size_t line = 1; line < lines.size(); ++line) {
      for (std::size_t column = has_particles ? 2 : 1; column < header.size(); ++column) {
        const double b = std::stod(pair.get(file, line, column));
        const double a = next_up(b);
        pair.set(file, line, column, hompm::to_text(a));
        const auto result = pair.compare();
        write_file(pair.a / file, original);
        INFO(lines[line]);
        CHECK(result.verdict == Verdict::different);
        CHECK(result.messages.empty());
        REQUIRE(result.first);
        CHECK(result.first->file == file);
        CHECK(result.first->field == header[column]);
        CHECK(result.first->time == std::stod(pair.get(file, line, 0)));
        CHECK(result.first->particle == (has_particles ? std::stoi(pair.get(file, line, 1)) : -1));
        CHECK(result.first->a == a);
        CHECK(result.first->b == b);
        CHECK(result.first->ulps == hompm::ulp_distance(a, b));  // 1; from -0 to the next it is 2
        std::uint64_t differing = 0;
        for (const auto& field : result.fields) differing += field.differing;
        CHECK(differing == 1);
      }
    }
  }
}

TEST_CASE("what does not touch the data is only noted", "[compare]") {
  const Pair pair;
  SECTION("CRLF") {
    pair.change_text("stress.csv", [](std::string& text) { text = joined(split(text, '\n'), "\r\n"); });
    CHECK(pair.compare().notes == Lines{(pair.a / "stress.csv").string() + " line 1: the lines end in CRLF"});
  }
  SECTION("order of columns") {
    pair.change_lines("stress.csv", [](Lines& lines) {
      for (auto& line : lines) {
        auto fields = split(line, ',');
        std::reverse(fields.begin(), fields.end());
        line = joined(fields, ",");
        line.pop_back();
      }
    });
    CHECK(pair.compare().notes ==
          Lines{(pair.a / "stress.csv").string() +
                " line 1: the columns are in another order than this version writes"});
  }
  SECTION("another spelling of the same number") { pair.set("stress.csv", 6, 0, "1e-1"); }
  const auto result = pair.compare();
  CHECK(result.verdict == Verdict::identical);
  CHECK(result.messages.empty());
}

TEST_CASE("negative zero against zero is a difference of one ulp with a note", "[compare]") {
  const Pair pair;
  pair.set("particles.csv", 2, 5, "-0");
  auto golden = read_file(pair.a / "particles.csv");
  write_file(pair.b / "particles.csv", golden.replace(golden.find(",-0,"), 4, ",0,"));
  const auto result = pair.compare();
  CHECK(result.verdict == Verdict::different);
  CHECK(result.messages.empty());
  CHECK(result.notes == Lines{(pair.a / "particles.csv").string() +
                              " line 3: -0 where line 3 of the other file has 0 (time 0, particle 1)"});
  REQUIRE(result.first);
  CHECK(result.first->ulps == 1);
  CHECK(pair.compare({{"velocity", {.ulps = 1}}}).verdict == Verdict::equivalent);
}

TEST_CASE("a tolerance holds up to its bound and for its field only", "[compare]") {
  const Pair pair;
  const double b = std::stod(pair.get("stress.csv", 7, 4));
  const auto verdict = [&](const std::string& field, const hompm::Tolerance& tolerance) {
    return pair.compare({{field, tolerance}}).verdict;
  };
  SECTION("absolute") {
    pair.set("stress.csv", 7, 4, hompm::to_text(b + 0.25));
    const double distance = (b + 0.25) - b;
    CHECK(verdict("stress", {.absolute = distance}) == Verdict::equivalent);
    CHECK(verdict("stress", {.absolute = std::nextafter(distance, 0.0)}) == Verdict::different);
    CHECK(verdict("stretch", {.absolute = 1.0}) == Verdict::different);
    const auto result = pair.compare({{"stress", {.absolute = 1.0}}});
    REQUIRE(result.first);
    CHECK(result.first->field == "stress");
  }
  SECTION("relative to the largest value at that time") {
    // The largest is that of the last particle, in the golden folder; times before and after are larger or
    // smaller.
    const double largest = std::stod(pair.get("stress.csv", 10, 4));
    REQUIRE(largest < std::stod(pair.get("stress.csv", 15, 4)));
    pair.set("stress.csv", 7, 4, hompm::to_text(b - 1.0));
    CHECK(verdict("stress", {.relative = 1.0 / largest * (1.0 + 1e-12)}) == Verdict::equivalent);
    CHECK(verdict("stress", {.relative = 1.0 / largest * (1.0 - 1e-12)}) == Verdict::different);
    const auto last = pair.get("stress.csv", 10, 4);
    pair.set("stress.csv", 10, 4, "1e9");  // the first folder's own values do not widen its bound
    CHECK(verdict("stress", {.relative = 1.0 / largest * (1.0 - 1e-12)}) == Verdict::different);
    pair.set("stress.csv", 10, 4, last);
    CHECK(verdict("stretch", {.relative = 1.0}) == Verdict::different);
    auto text = read_file(pair.b / "stress.csv");  // nor do values at another time
    text.replace(text.find(pair.get("stress.csv", 2, 4)), pair.get("stress.csv", 2, 4).size(), "1e9");
    write_file(pair.b / "stress.csv", text);
    pair.set("stress.csv", 2, 4, "1e9");
    CHECK(verdict("stress", {.relative = 1.0 / largest * (1.0 - 1e-12)}) == Verdict::different);
  }
  SECTION("ulps") {
    pair.set("stress.csv", 7, 4, hompm::to_text(next_up(next_up(b))));
    CHECK(verdict("stress", {.ulps = 2}) == Verdict::equivalent);
    CHECK(verdict("stress", {.ulps = 1}) == Verdict::different);
    CHECK(verdict("velocity", {.ulps = 2}) == Verdict::different);
  }
  SECTION("any of those that are set") {
    pair.set("stress.csv", 7, 4, hompm::to_text(b + 0.25));
    CHECK(verdict("stress", {.absolute = 1.0, .relative = 1e-15, .ulps = 1}) == Verdict::equivalent);
    CHECK(verdict("stress", {.absolute = 1e-15, .relative = 1.0, .ulps = 1}) == Verdict::equivalent);
    CHECK(verdict("stress", {.absolute = 1e-15, .relative = 1e-15, .ulps = 1}) == Verdict::different);
  }
}

TEST_CASE("the first difference is one that is beyond its tolerance", "[compare]") {
  const Pair pair;
  pair.set("particles.csv", 2, 6, "1");
  pair.set("particles.csv", 9, 7, "1");
  pair.set("stress.csv", 4, 5, "1");
  const hompm::Tolerance wide{.absolute = 1e6};
  const hompm::Tolerance relative{.relative = 1e6};
  CHECK(pair.compare().first->field == "volume");
  CHECK(pair.compare({{"volume", relative}}).first->field == "density");
  const auto last = pair.compare({{"volume", relative}, {"density", wide}});
  CHECK(last.verdict == Verdict::different);
  CHECK(last.first->field == "stretch");
  const auto none = pair.compare({{"volume", relative}, {"density", wide}, {"stretch", wide}});
  CHECK(none.verdict == Verdict::equivalent);
  CHECK(none.first->field == "volume");
}

TEST_CASE("the worst difference of a field is kept with its place", "[compare]") {
  const Pair pair;
  pair.set("history.csv", 1, 1, "1e-3");
  pair.set("history.csv", 2, 1, "-7");
  pair.set("history.csv", 3, 1, "0");
  const auto result = pair.compare({{"kinetic", {.absolute = 1.0}}});
  const auto& kinetic = result.fields[10];
  CHECK(kinetic.field == "kinetic");
  CHECK(kinetic.values == 3);
  CHECK(kinetic.differing == 3);
  CHECK(kinetic.beyond == 1);
  CHECK(kinetic.worst.time == 0.1);
  CHECK(kinetic.worst.a == -7.0);
  CHECK(kinetic.largest_absolute == std::abs(-7.0 - kinetic.worst.b));
}

TEST_CASE("scenes are compared as text", "[compare]") {
  const Pair pair;
  const auto compare_scenes = [&] {
    Comparison result;
    hompm::compare_scenes(pair.a, pair.b, result);
    CHECK((result.verdict == Verdict::different) == !result.messages.empty());
    return joined(result.messages, "\n");
  };
  CHECK(compare_scenes().empty());
  write_file(pair.a / "scene.toml", "case = \"bar\"\r\ncells = 64\r\n");
  CHECK(compare_scenes().empty());
  write_file(pair.a / "scene.toml", "case = \"bar\"\ncells = 65\n");
  CHECK(compare_scenes() == "scene.toml differs at line 2: `cells = 65` against `cells = 64`\n");
  write_file(pair.a / "scene.toml", "case = \"bar\"\ncells = 64\nend_time = 1\n");
  CHECK(compare_scenes() == "scene.toml differs at line 3: `end_time = 1` against the end of the file\n");
  write_file(pair.a / "scene.toml", "case = \"bar\"\n");
  CHECK(compare_scenes() == "scene.toml differs at line 2: the end of the file against `cells = 64`\n");
  fs::remove(pair.a / "scene.toml");
  CHECK(compare_scenes().empty());
}
