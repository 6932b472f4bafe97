// "Small" of the list of faults: what the tools say of themselves. Help is short where nothing was asked,
// fits a terminal, has letters; the version names the commit; whatever is printed is printed as JSON, too.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <hompm/effects/registry.hpp>
#include <hompm/kit/recorder/checkpoint.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/scheme/scheme.hpp>

#include "support/catch.hpp"
#include "support/run_command.hpp"

using hompm::test::contains;
using hompm::test::run_command;
using nlohmann::json;

namespace {

const std::string bin = HOMPM_BIN_DIR "/";
const std::vector<std::string> tools{"hompm-run", "hompm-diff", "hompm-study", "hompm-exact"};

std::string printed(const std::string& command) {
  const auto done = run_command(bin + command);
  INFO(command << ": " << done.err);
  CHECK(done.exit_code == 0);
  CHECK(done.err.empty());
  return done.out;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Of UTF-8: bytes that continue a character take no column.
std::ptrdiff_t columns(const std::string& line) {
  return std::ranges::count_if(line, [](char c) { return (c & 0xC0) != 0x80; });
}

void check_width(const std::string& text) {
  for (const std::string& line : lines_of(text)) {
    INFO(line);
    CHECK(columns(line) <= 80);
    CHECK(line.find('\033') == std::string::npos);  // no colours in a pipe
  }
}

}  // namespace

TEST_CASE("a tool without arguments says in 12 lines what it is for, --help all of it, a topic its part") {
  for (const std::string& tool : tools) {
    const auto nothing = run_command(bin + tool);
    CHECK(nothing.exit_code == 2);
    CHECK(nothing.out.empty());
    CHECK(nothing.err.starts_with("usage: " + tool));
    CHECK(lines_of(nothing.err).size() <= 12);
    const std::string help = printed(tool + " --help");
    CHECK(help.starts_with(nothing.err));
    CHECK(printed(tool + " -h") == help);
    check_width(help);
    const json told = json::parse(printed(tool + " --help --json"));
    CHECK(told["name"] == tool);
    for (const json& topic : told["topics"]) {
      const std::string name = topic["name"];
      CHECK_THAT(nothing.err, contains(name));
      const std::string text = printed(tool + " --help " + name);
      CHECK(text.starts_with(name + ": "));
      CHECK_THAT(help, contains(text));
      for (const json& option : topic["options"]) {
        const std::string full = option["name"];
        CHECK_THAT(text, contains("--" + full.substr(0, full.find(','))));
        CHECK_FALSE(option["meaning"].get<std::string>().empty());
      }
      for (const std::string example : topic["examples"]) CHECK(example.starts_with("hompm-"));
    }
    const auto misspelt = run_command(bin + tool + " --help outputz");
    CHECK(misspelt.exit_code == 2);
    CHECK_THAT(misspelt.err, contains("`outputz`"));
    CHECK(run_command(bin + tool + " --help outputs general").exit_code == 2);
  }
}

TEST_CASE("the version names the commit") {
  for (const std::string& tool : tools) {
    const json build = json::parse(printed(tool + " --version --json"));
    const std::string said = printed(tool + " --version");
    CHECK(said == tool + " " + build["version"].get<std::string>() + " (" +
                      build["commit"].get<std::string>() + ")\n");
    CHECK(printed(tool + " -V") == said);
    CHECK_FALSE(build["compiler"].get<std::string>().empty());
  }
}

TEST_CASE("examples of the help are commands that the tool understands") {
  for (const std::string& tool : tools) {
    const json told = json::parse(printed(tool + " --help --json"));
    std::vector<std::string> known;
    for (const json& topic : told["topics"])
      for (const json& option : topic["options"]) {
        const std::string name = option["name"];
        known.push_back("--" + name.substr(0, name.find(',')));
      }
    for (const json& topic : told["topics"])
      for (const std::string example : topic["examples"]) {
        INFO(example);
        std::istringstream words(example);
        for (std::string word; words >> word;)
          if (word.starts_with("--")) CHECK(std::ranges::find(known, word) != known.end());
      }
  }
}

TEST_CASE("the catalogue is told as JSON, with the formats of files") {
  check_width(printed("hompm-run --list"));
  const json all = json::parse(printed("hompm-run --list --json"));
  CHECK(all["cases"].size() == hompm::builtin_scenes().size());
  CHECK(all["effects"].size() == hompm::effect_catalogue().size());
  REQUIRE(all["schemes"].size() == hompm::scheme_table().size());
  for (std::size_t i = 0; i < all["schemes"].size(); ++i) {
    CHECK(all["schemes"][i]["name"] == hompm::scheme_table()[i].name);
    CHECK(all["schemes"][i]["highest_degree"] == hompm::scheme_table()[i].highest_degree);
  }
  CHECK(all["formats"]["checkpoint"] == hompm::checkpoint_format);
}

TEST_CASE("the default of the relaxation rate names every scheme that relaxes") {  // fault 20
  const json keys = json::parse(printed("hompm-run --keys --json"))["keys"];
  const auto rate =
      std::ranges::find_if(keys, [](const json& key) { return key["path"] == "scheme.relaxation_rate"; });
  REQUIRE(rate != keys.end());
  for (const auto& scheme : hompm::scheme_table()) {
    INFO(scheme.name);
    CHECK(((*rate)["default"].get<std::string>().find(scheme.name) != std::string::npos) == scheme.relaxes);
  }
}

TEST_CASE("the stages of a step are told as JSON") {
  for (const std::string scene : {" --case column", " --scene " HOMPM_SOURCE_DIR "/docs/scenes/contact.toml",
                                  " --case column --variant small --scheme total-lagrangian"}) {
    const std::string text = printed("hompm-run" + scene + " --explain");
    check_width(text);
    const json plan = json::parse(printed("hompm-run" + scene + " --explain --json"));
    std::size_t position = 0;  // the stages stand in the text in the same order
    for (const json& body : plan["bodies"]) {
      CHECK(body.contains("fields"));
      for (const json& stage : body["stages"]) {
        position = text.find(". ", position) + 2;
        position = text.find_first_not_of(' ', position);
        const std::string name = stage["name"];
        CHECK(text.compare(position, name.size(), name) == 0);
        CHECK_FALSE((stage["writes"].empty() && stage["changes"].empty()));
        CHECK_THAT(text, contains(stage["for"].get<std::string>().substr(0, 60)));
      }
    }
    CHECK(plan["steps"].get<double>() > 0.0);
  }
}

TEST_CASE("the critical step is told as JSON, of each body") {
  const json told = json::parse(printed("hompm-run --case column --critical-step --json"))["bodies"];
  REQUIRE(told.size() == 1);
  const json& limits = told[0]["limits"];
  CHECK(limits.front()["where"] == "at the start");
  CHECK(limits.back()["where"] == "refused above");
  // c = 10 m/s, h = 1/64 m: each of the two operations rounds once.
  for (const json& limit : limits) {
    const double courant = limit["step"].get<double>() * 10.0 * 64.0;
    CHECK(std::abs(limit["courant"].get<double>() - courant) <= 4e-16 * courant);
  }
  const json run = json::parse(printed("hompm-run --case column --explain --json"));
  CHECK(run["critical_time_step"] == limits.back()["step"]);
  CHECK(json::parse(printed("hompm-run --scene " HOMPM_SOURCE_DIR
                            "/docs/scenes/contact.toml --critical-step --json"))["bodies"]
            .size() == 2);
}

TEST_CASE("the points of a study are told as JSON") {
  const std::string study =
      "hompm-study --case bar --vary scheme=bspline,high-order --vary cells=8,16 --list";
  CHECK(json::parse(printed(study + " --json"))["points"].get<std::vector<std::string>>() ==
        lines_of(printed(study)));
}
