// How the comparison takes damaged results: each fault has its own message, and none is missed.
#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <sys/stat.h>
#include <utility>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/kit/verify/compare.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/run_pair.hpp"

using namespace hompm::test;
using hompm::compare_folders;
using hompm::Verdict;

TEST_CASE("each damage has its own message and makes the folders different", "[compare]") {
  // `expected` follows "<path of particles.csv in a>" and is the first message.
  struct Damage {
    std::string name;
    std::string expected;
    std::function<void(Lines&)> change;
  };
  const auto replace = [](std::size_t line, const std::string& from, const std::string& to) {
    return [=](Lines& lines) {
      const auto at = lines[line].find(from);
      REQUIRE(at != std::string::npos);
      lines[line].replace(at, from.size(), to);
    };
  };
  const auto last_value = [](std::size_t line, const std::string& value) {
    return [=](Lines& lines) { lines[line].replace(lines[line].rfind(',') + 1, std::string::npos, value); };
  };
  const std::vector<Damage> damages{
      {"swapped rows", " line 8: row order differs: particle 2 where 1 is expected",
       [](Lines& lines) { std::swap(lines[7], lines[8]); }},
      {"swapped times",
       " line 6: row order differs: time 0.1, particle 0 where time 0, particle 4 is expected",
       [](Lines& lines) { std::swap(lines[5], lines[6]); }},
      {"missing row", " line 9: the row of time 0.1, particle 2 is missing",
       [](Lines& lines) { lines.erase(lines.begin() + 8); }},
      {"missing first row", " line 2: the row of time 0, particle 0 is missing",
       [](Lines& lines) { lines.erase(lines.begin() + 1); }},
      {"missing last row", " line 16: the row of time 0.25, particle 4 is missing",
       [](Lines& lines) { lines.pop_back(); }},
      {"row moved far down", " line 4: the row of time 0, particle 2 is missing",
       [](Lines& lines) { std::rotate(lines.begin() + 3, lines.begin() + 4, lines.begin() + 9); }},
      {"row moved far up",
       " line 2: row order differs: time 0.1, particle 2 where time 0, particle 0 is expected",
       [](Lines& lines) { std::rotate(lines.begin() + 1, lines.begin() + 8, lines.begin() + 9); }},
      {"extra row", " line 7: extra row: time 0, particle 5",
       [](Lines& lines) { lines.insert(lines.begin() + 6, "0,5" + lines[5].substr(3)); }},
      {"extra last row", " line 17: extra row: time 0.25, particle 5",
       [](Lines& lines) { lines.push_back("0.25,5" + lines[15].substr(6)); }},
      {"old row at the end", " line 17: row order differs: time 0.25, particle 1 comes too late",
       [](Lines& lines) { lines.push_back(lines[12]); }},
      {"repeated row", " line 8: the row of time 0.1, particle 0 is there twice",
       [](Lines& lines) { lines.insert(lines.begin() + 7, lines[6]); }},
      {"only the header", " line 2: the row of time 0, particle 0 is missing",
       [](Lines& lines) { lines.resize(1); }},
      {"time off by one ulp",
       " line 7: row order differs: time 0.10000000000000002, particle 0 where time 0.1, particle 0 is "
       "expected",
       replace(6, "0.1,", "0.10000000000000002,")},
      {"time -0", " line 2: row order differs: time -0, particle 0 where time 0, particle 0 is expected",
       replace(1, "0,0,", "-0,0,")},
      {"nan", " line 4: `nan` in column `density` is not finite", last_value(3, "nan")},
      {"minus nan", " line 4: `-nan` in column `density` is not finite", last_value(3, "-nan")},
      {"infinity", " line 4: `-inf` in column `density` is not finite", last_value(3, "-inf")},
      {"overflow", " line 4: `1e999` in column `density` is beyond the range of a double",
       last_value(3, "1e999")},
      {"nan time", " line 4: `nan` in column `time` is not finite", replace(3, "0,2,", "nan,2,")},
      {"empty time", " line 2: `` in column `time` is not a number", replace(1, "0,0,", ",0,")},
      {"decimal comma", " line 4: 9 fields where the header has 8 (a decimal comma?): `0,2,",
       [](Lines& lines) { lines[3].replace(lines[3].rfind('.'), 1, ","); }},
      {"trailing blank", " line 4: `1 ` in column `density` is not a number", last_value(3, "1 ")},
      {"plus sign", " line 4: `+1` in column `density` is not a number", last_value(3, "+1")},
      {"hexadecimal", " line 4: `0x1p3` in column `density` is not a number", last_value(3, "0x1p3")},
      {"word", " line 4: `1.5abc` in column `density` is not a number", last_value(3, "1.5abc")},
      {"empty value", " line 4: `` in column `density` is not a number", last_value(3, "")},
      {"NUL byte", " line 4: `1\\x00` in column `density` is not a number",
       last_value(3, std::string("1\0", 2))},
      {"fractional particle", " line 4: `2.5` in column `particle` is not a particle number",
       replace(3, "0,2,", "0,2.5,")},
      {"negative particle", " line 2: `-1` in column `particle` is not a particle number",
       replace(1, "0,0,", "0,-1,")},
      {"empty line", " line 4: 1 fields where the header has 8: ``",
       [](Lines& lines) { lines.insert(lines.begin() + 3, ""); }},
      {"missing column", " line 1: the column `velocity` is missing", replace(0, "velocity", "speed")},
      {"unknown column", " line 1: the column `colour` is unknown and not compared",
       [](Lines& lines) {
         for (auto& line : lines) line += ",1";
         lines[0].replace(lines[0].rfind(',') + 1, 1, "colour");
       }},
      {"column twice", " line 1: the column `x` is there twice",
       [](Lines& lines) {
         for (auto& line : lines) line += ",1";
         lines[0].replace(lines[0].rfind(',') + 1, 1, "x");
       }},
      {"no particle numbers", " line 1: the column `particle` is missing", replace(0, "particle", "number")},
      {"semicolons", " line 1: the columns are separated by semicolons: commas between columns and points",
       [](Lines& lines) {
         for (auto& line : lines) std::replace(line.begin(), line.end(), ',', ';');
       }},
      {"byte order mark", " line 1: the column `time` is missing",
       [](Lines& lines) { lines[0] = "\xef\xbb\xbf" + lines[0]; }},
      {"no header", " line 1: the column `time` is missing",
       [](Lines& lines) { lines.erase(lines.begin()); }},
  };
  for (const auto& damage : damages) {
    const Pair pair;
    pair.change_lines("particles.csv", damage.change);
    const auto result = pair.compare();
    INFO(damage.name << "\n" << joined(result.messages, "\n"));
    CHECK(result.verdict == Verdict::different);
    REQUIRE_FALSE(result.messages.empty());
    CHECK(result.messages.front().starts_with((pair.a / "particles.csv").string() + damage.expected));
    CHECK(result.messages.size() <= (damage.expected.starts_with(" line 1:") ? 10 : 4));

    // The golden folder may be the damaged one, and no tolerance excuses any of this.
    const hompm::Tolerance wide{1e300, 1e300, std::numeric_limits<std::uint64_t>::max()};
    std::map<std::string, hompm::Tolerance> all;
    for (const auto& field : hompm::compared_fields()) all[field] = wide;
    CHECK(pair.compare(all).verdict == Verdict::different);
    CHECK(compare_folders(pair.b, pair.a, all).verdict == Verdict::different);
  }
}

TEST_CASE("damage of the golden folder is told as such", "[compare]") {
  const Pair pair;
  const auto golden = (pair.a / "particles.csv").string();
  SECTION("swapped rows") {
    pair.change_lines("particles.csv", [](Lines& lines) { std::swap(lines[7], lines[8]); });
    const auto result = compare_folders(pair.b, pair.a, {});
    CHECK(result.messages == Lines{golden + " line 8: row order differs: particle 2 where 1 is expected"});
  }
  SECTION("row moved far up") {
    pair.change_lines("particles.csv", [](Lines& lines) {
      std::rotate(lines.begin() + 2, lines.begin() + 8, lines.begin() + 9);
    });
    const auto result = compare_folders(pair.b, pair.a, {});
    CHECK(result.messages.front() ==
          golden + " line 3: row order differs: time 0.1, particle 2 where time 0, particle 1 is expected");
    CHECK(result.messages.size() == 2);
  }
  SECTION("repeated row") {
    pair.change_lines("particles.csv", [](Lines& lines) { lines.insert(lines.begin() + 7, lines[6]); });
    const auto result = compare_folders(pair.b, pair.a, {});
    CHECK(result.messages == Lines{golden + " line 8: the row of time 0.1, particle 0 is there twice"});
  }
  SECTION("missing row") {
    pair.change_lines("particles.csv", [](Lines& lines) { lines.erase(lines.begin() + 8); });
    const auto result = compare_folders(pair.b, pair.a, {});
    CHECK(result.messages ==
          Lines{(pair.b / "particles.csv").string() + " line 9: extra row: time 0.1, particle 2"});
  }
  SECTION("NaN in both") {
    pair.set("particles.csv", 3, 5, "nan");
    const auto result = compare_folders(pair.a, pair.a, {});
    CHECK(result.verdict == Verdict::different);
    CHECK(result.messages == Lines(2, golden + " line 4: `nan` in column `velocity` is not finite"));
  }
}

TEST_CASE("a damaged row does not hide a difference behind it", "[compare]") {
  const Pair pair;
  pair.set("particles.csv", 14, 4, "77");
  const auto change = GENERATE(
      as<std::function<void(Lines&)>>{}, [](Lines& l) { std::swap(l[2], l[3]); },
      [](Lines& l) { l.erase(l.begin() + 2); }, [](Lines& l) { l[4] = "x"; },
      [](Lines& l) { l.insert(l.begin() + 4, l[3]); });
  pair.change_lines("particles.csv", change);
  const auto result = pair.compare();
  CHECK(result.messages.size() <= 2);
  REQUIRE(result.first);
  CHECK(result.first->field == "displacement");
  CHECK(result.first->time == 0.25);
  CHECK(result.first->particle == 3);
  CHECK(result.first->a == 77.0);
}

TEST_CASE("a file cut anywhere is different, and never crashes the comparison", "[compare]") {
  const Pair pair;
  const auto text = read_file(pair.a / "stress.csv");
  for (std::size_t length = 0; length < text.size(); ++length) {
    write_file(pair.a / "stress.csv", text.substr(0, length));
    const auto result = pair.compare();
    INFO(length << " bytes: " << joined(result.messages, "\n"));
    REQUIRE(result.verdict == Verdict::different);
    REQUIRE_FALSE(result.messages.empty());
    REQUIRE(result.messages.front().starts_with((pair.a / "stress.csv").string()));
  }
  CHECK(pair.compare().messages.front() ==
        (pair.a / "stress.csv").string() + " line 16: the file is cut off: the last line has no end");
  write_file(pair.a / "stress.csv", "");
  CHECK(pair.compare().messages == Lines{(pair.a / "stress.csv").string() + ": the file is empty"});
}

TEST_CASE("a byte spoilt anywhere is found", "[compare]") {
  const Pair pair;
  const auto text = read_file(pair.a / "history.csv");
  for (const char spoilt : {'x', '\n', '\0'}) {
    for (std::size_t at = 0; at < text.size(); ++at) {
      if (text[at] == spoilt) continue;
      auto damaged = text;
      damaged[at] = spoilt;
      write_file(pair.a / "history.csv", damaged);
      INFO("byte " << at << " is " << static_cast<int>(spoilt));
      REQUIRE(pair.compare().verdict == Verdict::different);
    }
  }
}

TEST_CASE("binary garbage is refused or different", "[compare]") {
  const Pair pair;
  std::uint32_t state = 1;
  std::string garbage;
  for (int i = 0; i < 200000; ++i) {
    state = state * 1664525U + 1013904223U;
    garbage += static_cast<char>(state >> 24);
  }
  write_file(pair.a / "particles.csv", garbage);
  const auto result = pair.compare();
  CHECK(result.verdict == Verdict::different);
  CHECK(result.messages.size() < 50);

  std::replace(garbage.begin(), garbage.end(), '\n', ' ');
  write_file(pair.a / "particles.csv", garbage);
  CHECK_THROWS_AS(pair.compare(), hompm::FileError);
  // Behind a good header, too.
  write_file(pair.a / "particles.csv", read_file(pair.b / "particles.csv") + garbage);
  CHECK_THROWS_AS(pair.compare(), hompm::FileError);
}

TEST_CASE("a file only one folder has is a difference", "[compare]") {
  const Pair pair;
  fs::remove(pair.a / "stress.csv");
  const auto message =
      (pair.a / "stress.csv").string() + ": missing, but there is " + (pair.b / "stress.csv").string();
  CHECK(pair.compare().verdict == Verdict::different);
  CHECK(pair.compare().messages == Lines{message});
  CHECK(compare_folders(pair.b, pair.a, {}).messages == Lines{message});
  fs::remove(pair.b / "stress.csv");
  CHECK(pair.compare().verdict == Verdict::identical);
}

TEST_CASE("many faults of a kind make a short report", "[compare]") {
  const Pair pair;
  write_sample_run(pair.a, 1000);
  const auto result = pair.compare();
  const auto path = (pair.a / "particles.csv").string();
  CHECK(result.messages.size() == 2 * (3 + 1));
  CHECK(result.messages[0] == path + " line 7: extra row: time 0, particle 5");
  CHECK(result.messages[6] == path + ": extra rows: 2982 more");
}

TEST_CASE("what cannot be read is an error with path and reason", "[compare]") {
  const Pair pair;
  const auto message = [](const fs::path& a, const fs::path& b) -> std::string {
    try {
      compare_folders(a, b, {});
    } catch (const hompm::FileError& error) {
      return error.what();
    }
    return "";
  };
  const auto missing = pair.folder / "missing";
  CHECK(message(missing, pair.b) == "cannot read " + missing.string() + ": No such file or directory");
  CHECK(message(pair.a, missing) == "cannot read " + missing.string() + ": No such file or directory");
  CHECK(contains(message(pair.a / "stress.csv", pair.b), ": Not a directory"));
  fs::create_directories(pair.folder / "empty/too");
  CHECK(contains(message(pair.folder / "empty", pair.folder / "empty/too"), "empty holds no particles.csv"));
  CHECK(contains(message(pair.a, pair.folder / "empty"), "empty holds no particles.csv"));

  const auto file = pair.a / "stress.csv";
  fs::remove(file);
  fs::create_directory(file);
  CHECK(message(pair.a, pair.b) == "cannot read " + file.string() + ": not a regular file");
  fs::remove(file);
  REQUIRE(::mkfifo(file.c_str(), 0600) == 0);  // opening a pipe would wait for ever
  CHECK(message(pair.a, pair.b) == "cannot read " + file.string() + ": not a regular file");

  CHECK_THROWS_AS(pair.compare({{"strain", {.ulps = 1}}}), hompm::Error);
}
