// Scripts for gnuplot: what is on the page, and in which units.
#include <algorithm>
#include <cmath>
#include <regex>
#include <set>
#include <string>
#include <tuple>

#include <hompm/kit/output/gnuplot.hpp>
#include <hompm/scheme/scheme.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"

using namespace hompm::gnuplot;
using hompm::test::contains;

TEST_CASE("each scheme has a look of its own, in lines and in dots", "[gnuplot]") {
  std::set<std::pair<std::string, int>> lines, dots;
  for (const auto& scheme : hompm::scheme_table()) {
    const Stroke stroke = scheme_stroke(scheme.name);
    CHECK(std::regex_match(stroke.colour, std::regex("#[0-9A-F]{6}")));
    CHECK(lines.emplace(stroke.colour, stroke.dash).second);
    CHECK(dots.emplace("", stroke.shape).second);
  }
  CHECK(scheme_stroke("of somebody else").colour == "#808080");
}

TEST_CASE("shades go from white to black", "[gnuplot]") {
  CHECK(shade("#0072B2", 0.0) == "#0072B2");
  CHECK(shade("#0072B2", 1.0) == "#000000");
  CHECK(shade("#0072B2", -1.0) == "#FFFFFF");
  CHECK(shade("#0080FF", 0.5) == "#004080");
}

TEST_CASE("numbers are short, and their units fit them", "[gnuplot]") {
  CHECK(digits(1.0 / 3.0) == "0.33333");
  CHECK(digits(1234567.0, 3) == "1.23e+06");
  CHECK(readable(20000.0, "Pa") == "20 kPa");
  CHECK(readable(0.02, "s") == "20 ms");
  CHECK(readable(-3e-9, "m") == "-3 nm");
  CHECK(readable(1e25, "Pa") == "1e+16 GPa");
  CHECK(readable(0.0, "m") == "0 m");
  CHECK(readable(20000.0, "") == "2e+04 ");
}

TEST_CASE("decades hold what they are around", "[gnuplot]") {
  CHECK(decades(1e-3, 1e2).range('y') == "set yrange [0.001:100]\n");
  CHECK(decades(2e-3, 101.0).range('x') == "set xrange [0.001:1000]\n");
  CHECK(decades(10.0, 10.0).to == 100.0);
  const Decades tiny = decades(1e-323, 5e-323);  // subnormal numbers
  CHECK(tiny.from <= 1e-323);
  CHECK(tiny.to >= 5e-323);
}

TEST_CASE("a script puts all texts on the page, whatever they hold", "[gnuplot]") {
  Picture picture{.title = "it's a 'title'\nof two lines", .columns = 2};
  for (int i = 0; i < 3; ++i) {
    Panel panel{.title = "panel", .x = {"X", "m"}, .y = {"stress", "Pa"}, .own_legend = i == 2};
    for (int c = 0; c < (i == 2 ? 4 : 14); ++c)
      panel.curves.push_back({"a curve with a long name, " + std::to_string(c),
                              {.colour = "#000000", .width = 1.0, .size = 0.3},
                              {0.0, 1.0, 2.0},
                              {-2e4, NAN, 1e4}});
    picture.panels.push_back(panel);
  }
  picture.panels.push_back({.title = "none",
                            .x = {"X"},
                            .y = {"Y"},
                            .note = "a sentence that is longer than the panel is wide and must be cut"});
  const std::string text = script(picture, ".svg", "a.svg");
  CHECK(contains(text, "set label 'it''s a ''title'' of two lines'"));
  CHECK(contains(text, "'stress, kPa'"));
  CHECK(contains(text, "0 -20\n2 10\n"));  // not the value that is none
  const std::regex place("screen ([-+.e0-9]+),screen ([-+.e0-9]+)");
  std::size_t places = 0;
  for (auto at = std::sregex_iterator(text.begin(), text.end(), place); at != std::sregex_iterator();
       ++at, ++places) {
    INFO(at->str());
    for (const int i : {1, 2})
      CHECK((std::stod(at->str(static_cast<std::size_t>(i))) > 0.0 &&
             std::stod(at->str(static_cast<std::size_t>(i))) < 1.0));
  }
  CHECK(places > 2 * (14 + 4) * 2);
  // A name is in the legend once, and in that of the panel which has one of its own.
  const std::string entry = "set label 'a curve with a long name, 3'";
  const auto first = text.find(entry);
  const auto second = text.find(entry, first + 1);
  CHECK(second != std::string::npos);
  CHECK(text.find(entry, second + 1) == std::string::npos);
  CHECK(contains(text, "set label 'a sentence that is'"));
}

TEST_CASE("an axis of powers of ten leaves out what has no logarithm", "[gnuplot]") {
  const Picture picture{
      .title = "t",
      .panels = {{.title = "p",
                  .x = {"t"},
                  .y = {"e"},
                  .logarithmic = true,
                  .curves = {{"", {.colour = "#000000", .width = 1.0}, {0.0, 1.0, 2.0}, {0.0, 2e-3, 0.5}}}}}};
  const std::string text = script(picture, ".pdf", "");
  CHECK(contains(text, "set terminal pdfcairo"));
  CHECK_FALSE(contains(text, "\nset output"));
  CHECK(contains(text, "EOD\n1 0.002\n2 0.5\nEOD"));
  CHECK(contains(text, "set yrange [0.001:1]"));
}

TEST_CASE("marks along X are few", "[gnuplot]") {
  for (const auto& [length, marks] :
       {std::pair{0.996, "0.2"}, {2.5, "0.5"}, {5.0, "1"}, {24.9, "5"}, {60.0, "20"}, {0.0, "autofreq"}}) {
    const Stroke line{.colour = "#000000", .width = 1.0};
    const Picture picture{
        .title = "t",
        .panels = {
            {.title = "p", .x = {"X"}, .y = {"u"}, .curves = {{"", line, {1.0, 1.0 + length}, {0.0, 1.0}}}}}};
    CHECK(contains(script(picture, ".svg", ""), std::string("set xtics ") + marks + "\n"));
  }
}

TEST_CASE("an image has colours around zero where both signs matter, and a scale in a unit that fits",
          "[gnuplot]") {
  Picture picture{.title = "t",
                  .panels = {{.title = "stress",
                              .x = {"X", "m"},
                              .y = {"t", "s"},
                              .images = {{.x = 0.25,
                                          .dx = 0.5,
                                          .y = 0.0,
                                          .dy = 0.1,
                                          .columns = 2,
                                          .values = {0.0, -4000.0, 2000.0, 1000.0}}},
                              .image_unit = "Pa"}}};
  std::string text = script(picture, ".png", "");
  CHECK(contains(text, "EOD\n0 -4\n2 1\nEOD"));
  CHECK(contains(text, "set cbrange [-4:4]"));
  CHECK(contains(text, "'stress, kPa'"));
  CHECK(contains(text, "(0.25+$1*0.5):(0+$2*0.1):3 with image"));
  picture.panels[0].images[0].values = {0.0, 1.0, 2.0, 3.0};
  text = script(picture, ".png", "");
  CHECK(contains(text, "set cbrange [0:3]"));
}
