// Scene files: what is read comes back the same, overrides follow their rules, and nothing wrong passes
// unnoticed.
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <hompm/effects/registry.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/scene_file/value_rule.hpp>
#include <hompm/scheme/scheme.hpp>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace hompm;

namespace {

const std::string minimal = R"(end_time = 1
[body]
length = 2
[material]
law = "rate"
density = 1000
youngs_modulus = 1e5
[scheme]
cells = 9
particles_per_cell = 4
courant = 0.5
)";

/// The minimal scene with more text at its end.
Scene read(const std::string& more = "", const std::vector<Override>& overrides = {}) {
  return parse_scene(minimal + more, "scenes/block.toml", overrides);
}

Override set(const std::string& key, const std::string& value) {
  return {key, value, "--set " + key + "=" + value};
}

/// What is wrong with the scene that `load` makes; empty when nothing is.
template <class Load>
std::vector<Problem> problems_of(Load load) {
  try {
    load();
  } catch (const SceneError& error) {
    return error.problems();
  }
  return {};
}

/// The one problem of the column with the overrides, as a line.
std::string problem_with(const std::vector<Override>& overrides) {
  const auto problems = problems_of([&] { load_builtin("column", "", overrides); });
  REQUIRE(problems.size() == 1);
  return problems.front().origin.text() + ": " + problems.front().message;
}

/// All of a scene but the origins.
void check_same(const Scene& a, const Scene& b) {
  CHECK(a.case_name == b.case_name);
  CHECK(a.variant == b.variant);
  CHECK(a.title == b.title);
  CHECK(a.end_time == b.end_time);
  CHECK(a.kinematics == b.kinematics);
  CHECK(a.body.length == b.body.length);
  CHECK(a.material.law == b.material.law);
  CHECK(a.material.density == b.material.density);
  CHECK(a.material.youngs_modulus == b.material.youngs_modulus);
  REQUIRE(a.initial_velocity.has_value() == b.initial_velocity.has_value());
  if (a.initial_velocity) {
    CHECK(a.initial_velocity->shape == b.initial_velocity->shape);
    CHECK(a.initial_velocity->amplitude == b.initial_velocity->amplitude);
    CHECK(a.initial_velocity->mode == b.initial_velocity->mode);
  }
  CHECK(a.ends.left == b.ends.left);
  CHECK(a.ends.right == b.ends.right);
  REQUIRE(a.effects.size() == b.effects.size());
  for (std::size_t index = 0; index < a.effects.size(); ++index) {
    CHECK(a.effects[index].type == b.effects[index].type);
    CHECK(a.effects[index].parameters == b.effects[index].parameters);
  }
  REQUIRE(a.rest.has_value() == b.rest.has_value());
  if (a.rest) CHECK(a.rest->speed == b.rest->speed);
  CHECK(a.scheme.name == b.scheme.name);
  CHECK(a.scheme.degree == b.scheme.degree);
  CHECK(a.scheme.cells == b.scheme.cells);
  CHECK(a.scheme.particles_per_cell == b.scheme.particles_per_cell);
  CHECK(a.scheme.margin_cells == b.scheme.margin_cells);
  CHECK(a.scheme.time_step == b.scheme.time_step);
  CHECK(a.scheme.courant == b.scheme.courant);
  CHECK(a.scheme.step_fraction == b.scheme.step_fraction);
  CHECK(a.scheme.allow_unstable == b.scheme.allow_unstable);
  CHECK(a.output.snapshots == b.output.snapshots);
  CHECK(a.output.history == b.output.history);
}

void check_round_trip(const Scene& scene) {
  const std::string text = scene_text(scene);
  INFO(text);
  const Scene again = parse_scene(text, "resolved.toml", {});
  check_same(scene, again);
  CHECK(scene_text(again) == text);
}

}  // namespace

TEST_CASE("A built-in scene written and read again is the same scene, and the same bytes") {
  CHECK(builtin_scenes().size() == 5);
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const Scene scene = load_builtin(builtin.case_name, builtin.variant, {});
    CHECK(scene.case_name == builtin.case_name);
    CHECK(scene.variant == builtin.variant);
    CHECK_FALSE(scene.title.empty());
    check_round_trip(scene);
  }
}

TEST_CASE("A scene with every key set survives writing and reading") {
  Scene scene = read(R"([initial.velocity]
shape = "sine"
amplitude = -0.1
mode = 3
[ends]
right = "free"
[[effect]]
type = "traction"
value = 0.30000000000000004
[[effect]]
type = "local-damping"
coefficient = 0.1
[rest]
speed = 1e-9
[output]
snapshots = 7
history = 123
)");
  scene.title = "quotes \" and \\, a tab \t, a line\nbreak, DEL \x7f, ä and 力";
  scene.scheme.courant.reset();
  scene.scheme.time_step = 2.2250738585072014e-308;
  scene.scheme.allow_unstable = true;
  scene.body.length = 1.0 / 3.0;
  scene.material.youngs_modulus = 1.7976931348623157e308;
  scene.end_time = 1e22;
  scene.effects[0].parameters["value"] = -0.0;
  check_round_trip(scene);
}

TEST_CASE("A resolved scene tells every default and every unit") {
  CHECK(scene_text(read("[[effect]]\ntype = \"mass-damping\"\nrate = 3\n[rest]\nspeed = 1e-6\n")) ==
        R"(case = "block"
variant = ""
title = ""
end_time = 1.0  # s
kinematics = "finite"

[body]
length = 2.0  # m

[material]
law = "rate"
density = 1000.0  # kg/m³
youngs_modulus = 1e+05  # Pa

[ends]
left = "fixed"
right = "fixed"

[[effect]]
type = "mass-damping"
rate = 3.0  # 1/s

[rest]
speed = 1e-06  # m/s

[scheme]
name = "tielen2017"
degree = 2
cells = 9
particles_per_cell = 4
margin_cells = 4
courant = 0.5
basis = "splines"
formulation = "updated-lagrangian"
quadrature = "reconstructed"
acceleration_mass = "lumped"
velocity_projection = "consistent"
sequence = "musl"
transfer = "flip"
flip_fraction = 1.0
xpic_order = 2
stress_update = "incremental"
time_integrator = "euler-cromer"
free_end = "cut-span"
markers = false
conserve = "nothing"
relaxation_rate = 0.0  # 1/s
allow_unstable = false

[output]
snapshots = 10
history = 100
)");
}

TEST_CASE("Without a variant the large one is taken") {
  CHECK(load_builtin("bar", "", {}).variant == "large");
  CHECK(load_builtin("column", "", {}).variant == "large");
  CHECK(load_builtin("bar", "", {}).initial_velocity.value().amplitude == 1.0);
  const Scene settled = load_builtin("column", "settled", {});
  CHECK(settled.effects.size() == 2);
  CHECK(settled.effects.at(1).number("coefficient") == 0.7);
  CHECK(settled.rest.value().speed == 1e-6);
  CHECK(settled.scheme.time_step == 2e-4);
}

TEST_CASE("An unknown built-in scene is answered with the nearest one") {
  const auto line = [](const std::string& name, const std::string& variant) {
    const auto problems = problems_of([&] { load_builtin(name, variant, {}); });
    REQUIRE(problems.size() == 1);
    return problems.front().origin.text() + ": " + problems.front().message;
  };
  CHECK(line("colum", "") == "--case colum: unknown case; did you mean column?");
  CHECK(line("beam", "") == "--case beam: unknown case; there are bar, column");
  CHECK(line("bar", "lagre") == "--variant lagre: unknown variant of the case bar; did you mean large?");
  CHECK(line("bar", "settled") ==
        "--variant settled: unknown variant of the case bar; there are large, small");
}

TEST_CASE("What a scene does not say has its default") {
  const Scene scene = read();
  CHECK(scene.case_name == "block");
  CHECK(scene.variant.empty());
  CHECK(scene.kinematics == Kinematics::finite);
  CHECK_FALSE(scene.initial_velocity);
  CHECK_FALSE(scene.rest);
  CHECK(scene.effects.empty());
  CHECK(scene.ends.left == End::fixed);
  CHECK(scene.ends.right == End::fixed);
  CHECK(scene.scheme.name == "tielen2017");
  CHECK(scene.scheme.degree == find_scheme("tielen2017").default_degree);
  CHECK(scene.scheme.margin_cells == 4);
  CHECK_FALSE(scene.scheme.allow_unstable);
  CHECK(scene.output.snapshots == 10);
  CHECK(scene.output.history == 100);
  CHECK(read("", {set("scheme.cells", "64")}).scheme.margin_cells == 16);
  CHECK(read("", {set("scheme.cells", "65")}).scheme.margin_cells == 17);
  CHECK(read("", {set("scheme.degree", "5")}).scheme.margin_cells == 7);
  CHECK(read("", {set("material.law", "linear")}).kinematics == Kinematics::infinitesimal);
  CHECK(read("[[effect]]\ntype = \"traction\"\nvalue = 1\n[ends]\nright = \"free\"")
            .effects.at(0)
            .text("end") == "right");
}

TEST_CASE("An optional table without keys counts as left out") {
  const Scene scene = read("[initial.velocity]\n[rest]\n[output]\n");
  CHECK_FALSE(scene.initial_velocity);
  CHECK_FALSE(scene.rest);
}

TEST_CASE("A whole number is a number") {
  const Scene scene = read("[[effect]]\ntype = \"gravity\"\nacceleration = -10");
  CHECK(scene.body.length == 2.0);
  CHECK(scene.effects.at(0).number("acceleration") == -10.0);
}

TEST_CASE("Each key that was said has its origin, and no other key has one") {
  const Scene scene = read("[[effect]]\ntype = \"gravity\"\n  acceleration = -10\n",
                           {set("scheme.cells", "16"), set("effect.gravity.acceleration", "-1")});
  std::map<std::string, std::string> origins;
  for (const auto& [key, origin] : scene.origins) origins[key] = origin.text();
  const std::map<std::string, std::string> expected{
      {"end_time", "scenes/block.toml:1:1"},
      {"body.length", "scenes/block.toml:3:1"},
      {"material.law", "scenes/block.toml:5:1"},
      {"material.density", "scenes/block.toml:6:1"},
      {"material.youngs_modulus", "scenes/block.toml:7:1"},
      {"scheme.cells", "--set scheme.cells=16"},
      {"scheme.particles_per_cell", "scenes/block.toml:10:1"},
      {"scheme.courant", "scenes/block.toml:11:1"},
      {"effect[0]", "scenes/block.toml:12:1"},
      {"effect[0].type", "scenes/block.toml:13:1"},
      {"effect[0].acceleration", "--set effect.gravity.acceleration=-1"}};
  CHECK(origins == expected);
  CHECK(scene.effects.at(0).origin.text() == "scenes/block.toml:12:1");
}

TEST_CASE("Another scheme keeps what suits it, and brings its own for the rest") {
  const std::string degree = "degree = 3\nmargin_cells = 20\n";
  CHECK(read(degree).scheme.degree == 3);
  const Scene other = read(degree, {set("scheme.name", "classical")});
  CHECK(other.scheme.degree == 1);
  CHECK(other.scheme.margin_cells == 20);
  const Scene kept = read(degree, {set("scheme.name", "bspline"), set("scheme.degree", "4")});
  CHECK(kept.scheme.degree == 4);
  CHECK(kept.scheme.margin_cells == 20);
  CHECK(read(degree, {set("scheme.cells", "8")}).scheme.margin_cells == 20);
}

TEST_CASE("One way to give the time step replaces the others") {
  for (const std::string key : {"time_step", "courant", "step_fraction"}) {
    const Scene scene = load_builtin("column", "", {set("scheme." + key, "0.25")});
    CHECK(scene.scheme.time_step.has_value() == (key == "time_step"));
    CHECK(scene.scheme.courant.has_value() == (key == "courant"));
    CHECK(scene.scheme.step_fraction.has_value() == (key == "step_fraction"));
    CHECK(scene.origins.contains("scheme.time_step") == (key == "time_step"));
  }
  CHECK(problem_with({set("scheme.courant", "0.5"), set("scheme.time_step", "1e-4")})
            .find("exclude each other") != std::string::npos);
}

TEST_CASE("An override is a TOML value or a bare word, and is given once") {
  CHECK(read("", {set("title", "a draft, nothing more")}).title == "a draft, nothing more");
  CHECK(read("", {set("title", "\"quoted\"")}).title == "quoted");
  CHECK(read("", {set("scheme.name", "bspline")}).scheme.name == "bspline");
  CHECK(read("", {set("scheme.allow_unstable", "true")}).scheme.allow_unstable);
  CHECK(read("", {set("end_time", "1_000")}).end_time == 1000.0);
  CHECK(read("", {set("rest.speed", "1e-6")}).rest.value().speed == 1e-6);
  CHECK(problem_with({set("scheme.cells", "4"), set("scheme.cells", "6")}) ==
        "--set scheme.cells=6: `scheme.cells` is said twice, here and by --set scheme.cells=4: give it once");
}

TEST_CASE("An override that is wrong is named with its option, its value and what is valid") {
  CHECK(problem_with({{"scheme.cells", "-3", "--cells -3"}}) ==
        "--cells -3: `scheme.cells` must be a whole number from 1 to 10000000, not -3");
  CHECK(problem_with({{"scheme.degree", "9", "--degree 9"}}) ==
        "--degree 9: `scheme.degree` must be a whole number from 1 to 5 with the scheme tielen2017, not 9");
  CHECK(problem_with({{"end_time", "nan", "--end-time nan"}}) ==
        "--end-time nan: `end_time` must be a number greater than 0 (s), not nan");
  CHECK(problem_with({{"scheme.time_step", "1e-4x", "--time-step 1e-4x"}}) ==
        "--time-step 1e-4x: `scheme.time_step` must be a number greater than 0 (s), not \"1e-4x\": \"x\" is "
        "no unit; there are "
        "kg, g, t, m, s, Hz, N, Pa, J, with G, M, k, c, m, µ before them");
  CHECK(problem_with({set("scheme.cells", "")}) ==
        "--set scheme.cells=: `scheme.cells` must be a whole number from 1 to 10000000, not \"\"");
  CHECK(problem_with({set("scheme.cels", "3")}) ==
        "--set scheme.cels=3: unknown key `scheme.cels`; did you mean `scheme.cells`?");
  CHECK(problem_with({set("cells", "3")}) ==
        "--set cells=3: unknown key `cells`; did you mean `scheme.cells`?");
  CHECK(problem_with({set("wind", "3")}) == "--set wind=3: unknown key `wind`");
  CHECK(problem_with({set("body.length.value", "3")}) ==
        "--set body.length.value=3: unknown key `body.length.value`");
  CHECK(problem_with({set("body", "3")}) == "--set body=3: `body` must be a table, [body], not 3");
  CHECK(problem_with({set("body", "{length = 3}")}) ==
        "--set body={length = 3}: `body` takes one value, not a table");
  CHECK(problem_with({set("scheme.cells", "3\nend_time = 7")}) ==
        "--set scheme.cells=3\\u000Aend_time = 7: `scheme.cells` must be a whole number from 1 to 10000000, "
        "not "
        "\"3\\u000Aend_time = 7\"");
}

TEST_CASE("An effect is overridden by its place or by its type") {
  const std::string two =
      "[[effect]]\ntype = \"gravity\"\nacceleration = 1\n[[effect]]\ntype = \"gravity\"\nacceleration = 2\n";
  const auto accelerations = [&](const std::string& key) {
    const Scene scene = read(two, {set(key, "7")});
    return std::pair{scene.effects.at(0).number("acceleration"), scene.effects.at(1).number("acceleration")};
  };
  CHECK(accelerations("effect[0].acceleration") == std::pair{7.0, 2.0});
  CHECK(accelerations("effect[1].acceleration") == std::pair{1.0, 7.0});
  CHECK(accelerations("effect.gravity.acceleration") == std::pair{7.0, 2.0});

  CHECK(problem_with({set("effect.local-damping.coefficient", "0.1")}) ==
        "--set effect.local-damping.coefficient=0.1: the scene has no effect `local-damping`; its effects: "
        "gravity");
  CHECK(problem_with({set("effect[1].acceleration", "0")}) ==
        "--set effect[1].acceleration=0: the scene has no effect `effect[1]`; its effects: gravity");
  CHECK(problem_with({set("effect.gravity.accelaration", "0")}) ==
        "--set effect.gravity.accelaration=0: unknown key `accelaration` of the effect gravity; did you mean "
        "`acceleration`?");
  for (const std::string key : {"effect", "effect[0]", "effect.gravity", "effect.gravity."}) {
    CHECK(problem_with({set(key, "0")}).find("names no parameter of an effect") != std::string::npos);
  }
  for (const std::string key :
       {"effect[].x", "effect[-1].x", "effect[0x0].x", "effect[99999999999999999999].x"}) {
    CHECK(problem_with({set(key, "0")}).find("the scene has no effect") != std::string::npos);
  }
  const auto none = problems_of([] { read("", {set("effect.gravity.acceleration", "1")}); });
  REQUIRE(none.size() == 1);
  CHECK(none.front().message == "the scene has no effect `gravity`; it has no effects");
}

TEST_CASE("Problems of options come after those of the file, all at once") {
  const auto problems = problems_of([] {
    read("typo = 1\n", {set("output.snapshots", "0"), set("end_time", "-1"), set("wind", "1")});
  });
  REQUIRE(problems.size() == 4);
  CHECK(problems[0].origin.text() == "scenes/block.toml:12:1");
  std::set<std::string> options;
  for (std::size_t index = 1; index < 4; ++index) options.insert(problems[index].origin.text());
  CHECK(options == std::set<std::string>{"--set output.snapshots=0", "--set end_time=-1", "--set wind=1"});
}

TEST_CASE("A file that is no scene gives an error and no crash") {
  const auto count = [](const std::string& text) {
    return problems_of([&] { parse_scene(text, "odd.toml", {}); }).size();
  };
  CHECK(count("") == 8);
  CHECK(count(std::string(1000, '\0')) == 1);
  CHECK(count(minimal + std::string(1, '\0')) == 1);
  CHECK(count("\xff\xfe" + minimal) == 1);
  CHECK(count("title = \"\xc3\x28\"\n" + minimal) == 1);
  CHECK(count("a = " + std::string(1'000'000, '[')) == 1);
  std::string dotted = "a";
  for (int level = 0; level < 300'000; ++level) dotted += ".a";
  CHECK(count(dotted + " = 1") == 1);
  CHECK(count('[' + dotted + ']') == 1);
  CHECK(count(std::string(1'000'000, 'a') + " = 1\n" + minimal) == 1);
  CHECK(count("kinematics = \"" + std::string(1'000'000, 'a') + "\"\n" + minimal) == 1);
  std::string garbage;
  for (unsigned state = 1; garbage.size() < 1'000'000; state = state * 1664525U + 1013904223U) {
    garbage += static_cast<char>(state >> 24U);
  }
  CHECK(count(garbage) == 1);
}

TEST_CASE("A message is one line of a readable length, whatever the file holds") {
  const std::string odd = "new\\nline" + std::string(1000, 'a') + '"';
  const auto problems =
      problems_of([&] { read("\"k " + odd + " = 1\n[\"t " + odd + "]\n[rest]\nspeed = \"" + odd + "\n"); });
  REQUIRE(problems.size() == 3);
  for (const Problem& problem : problems) {
    CHECK(problem.message.find('\n') == std::string::npos);
    CHECK(problem.message.find("new\\u000Aline") != std::string::npos);
    CHECK(problem.message.size() < 300);
  }
}

TEST_CASE("A byte order mark and carriage returns change nothing") {
  std::string text = "\xef\xbb\xbf";
  for (const char character : minimal) text += character == '\n' ? "\r\n" : std::string(1, character);
  check_same(parse_scene(text, "scenes/block.toml", {}), read());
}

TEST_CASE("A file that cannot be read is named") {
  const test::TemporaryFolder folder;
  CHECK_THROWS_AS(load_scene((folder / "absent.toml").string(), {}), FileError);
  CHECK_THROWS_AS(load_scene(folder.path().string(), {}), FileError);
  const auto file = folder / "block.toml";
  test::write_file(file, minimal);
  CHECK(load_scene(file.string(), {}).case_name == "block");
  test::write_file(file, std::string(5U << 20U, '#'));
  CHECK_THROWS_AS(load_scene(file.string(), {}), FileError);
  try {
    load_scene((folder / "absent.toml").string(), {});
  } catch (const FileError& error) {
    CHECK(std::string(error.what()).find("absent.toml: No such file") != std::string::npos);
  }
}

TEST_CASE("The list of keys tells the defaults that the reader uses") {
  const Scene scene = read("[initial.velocity]\nshape = \"sine\"\namplitude = 1\n");
  const std::string text = scene_text(scene);
  std::set<std::string> paths;
  for (const SceneKey& key : scene_keys()) {
    CHECK(paths.insert(key.path).second);
    CHECK_FALSE(key.meaning.empty());
    const bool toml = key.standard == "true" || key.standard == "false" || key.standard.starts_with('"') ||
                      key.standard.find_first_not_of("0123456789") == std::string::npos;
    if (key.standard.empty() || !toml) continue;
    const std::string name = key.path.substr(key.path.rfind('.') + 1);
    INFO(key.path);
    if (text.find(name + " = ") != std::string::npos) {
      CHECK(text.find(name + " = " + key.standard + '\n') != std::string::npos);
      continue;
    }
    // Not written where it is the default; another word is.
    const auto said = [&](const std::string& word) {
      return scene_text(parse_scene(text, "written", {{key.path, word, key.path}}));
    };
    CHECK(said(key.standard) == text);
    REQUIRE(key.words.size() == 2);
    CHECK(said(key.words[1]).find(name + " = \"" + key.words[1] + "\"\n") != std::string::npos);
  }
  for (const std::string path :
       {"case", "end_time", "scheme.margin_cells", "initial.velocity.mode", "rest.speed"}) {
    CHECK(paths.contains(path));
  }
}

TEST_CASE("The nearest word is one that was probably meant") {
  const std::vector<std::string> words{"rate", "hencky", "neo-hookean", "tielen2017"};
  CHECK(nearest("ratte", words) == "rate");
  CHECK(nearest("arte", words) == "rate");
  CHECK(nearest("RATE", words) == "rate");
  CHECK(nearest("neohookean", words) == "neo-hookean");
  CHECK(nearest("tielen", words) == "tielen2017");
  CHECK(nearest("linear", words).empty());
  CHECK(nearest("", words).empty());
  CHECK(nearest("rate", {}).empty());
  CHECK(nearest("bat", {"bar", "bad"}) == "bar");
}

TEST_CASE("Every bad scene is refused for exactly the reasons it names") {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(HOMPM_SOURCE_DIR "/tests/scenes/bad")) {
    if (entry.path().extension() != ".toml") continue;
    ++files;
    INFO(entry.path().filename().string());
    std::ifstream file(entry.path());
    const std::string mark = "# expect: ";
    std::vector<std::string> expected;
    for (std::string line; std::getline(file, line) && line.starts_with(mark);) {
      expected.push_back(line.substr(mark.size()));
    }
    REQUIRE_FALSE(expected.empty());
    const auto problems = problems_of([&] { load_scene(entry.path().string(), {}); });
    std::vector<std::string> found;
    for (const Problem& problem : problems) {
      found.push_back(std::to_string(problem.origin.line) + ':' + std::to_string(problem.origin.column) +
                      ": " + problem.message);
      CHECK(problem.origin.source == entry.path().string());
    }
    std::string all;
    for (const std::string& line : found) all += line + '\n';
    INFO(all);
    REQUIRE(found.size() == expected.size());
    for (std::size_t index = 0; index < found.size(); ++index) {
      // "line:column: " must agree; what follows must be part of the message.
      const std::size_t message = expected[index].find(": ") + 2;
      INFO(expected[index]);
      CHECK(found[index].substr(0, message) == expected[index].substr(0, message));
      CHECK(found[index].find(expected[index].substr(message)) != std::string::npos);
    }
  }
  CHECK(files >= 30);
}

TEST_CASE("an effect outside the catalogue is written without units") {
  Scene scene = read("");
  EffectSpec effect;
  effect.type = "wind";
  effect.parameters["speed"] = 3.0;
  scene.effects.push_back(effect);
  CHECK_THAT(scene_text(scene), hompm::test::contains("[[effect]]\ntype = \"wind\"\nspeed = 3.0\n"));
}

TEST_CASE("A bound is told as it is, whole or not") {
  const auto demand = [](double minimum, double maximum) {
    return hompm::detail::demand(
        {.type = hompm::detail::ValueType::number, .minimum = minimum, .maximum = maximum});
  };
  CHECK(demand(0.5, 2.0) == "a number from 0.5 to 2");
  CHECK(demand(0.0, 1e20) == "a number from 0 to 1e+20");
}
