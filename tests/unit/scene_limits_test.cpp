// Files that say more than any scene are refused soon and in few words.
#include <algorithm>
#include <string>

#include <hompm/kit/scene_file/reader.hpp>

#include "support/catch.hpp"

using namespace hompm;

namespace {

const std::string one_body = R"(
[body]
length = 2
)";

/// A scene that begins with `top` and ends with `tables`.
std::string scene(const std::string& top, const std::string& tables) {
  return top + R"(
end_time = 1
[material]
law = "rate"
density = 1000
youngs_modulus = 1e5
[scheme]
cells = 9
particles_per_cell = 4
courant = 0.5
)" + tables;
}

std::string repeated(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

std::string unknown_keys(int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += "a" + std::to_string(i) + " = 1\n";
  return all;
}

SceneError error_of(const std::string& text, const std::vector<Override>& overrides = {}) {
  try {
    parse_scene(text, "limits.toml", overrides);
  } catch (const SceneError& error) {
    return error;
  }
  FAIL("the scene is not refused");
  throw;
}

std::size_t lines(const std::string& text) {
  return 1 + static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_CASE("A file with more keys than any scene is refused as a whole") {
  const SceneError error = error_of(scene(unknown_keys(100'000), one_body));
  CHECK(std::string(error.what()) ==
        "limits.toml: there are 100011 keys and tables; a scene has at most 100000");
}

TEST_CASE("Of many problems the first hundred are printed and the others counted") {
  const SceneError error = error_of(scene(unknown_keys(250), one_body));
  CHECK(error.problems().size() == 250);
  const std::string text = error.what();
  CHECK(lines(text) == 101);
  CHECK(text.ends_with("\nand 150 more problems"));
}

TEST_CASE("What a thousand bodies share is told wrong for one of them") {
  const SceneError error = error_of(scene(unknown_keys(250), repeated(1000, "[[body]]\nlength = 1\n")));
  CHECK(error.problems().size() == 250);
}

TEST_CASE("Bodies times effects are bounded") {
  const std::string bodies = repeated(1000, "[[body]]\nlength = 1\n");
  const std::string effect = "[[effect]]\ntype = \"gravity\"\nacceleration = 1\n";
  const SceneError error = error_of(scene("", bodies + repeated(101, effect)));
  CHECK(std::string(error.what()).find("at most 100 [[effect]] tables, not 101") != std::string::npos);
  CHECK(parse_scene(scene("", repeated(10, "[[body]]\nlength = 1\n") + repeated(101, effect)), "limits.toml",
                    {})
            .effects.size() == 101);
}

TEST_CASE("An override of something like a body is refused") {
  const std::string text = scene("", "[[body]]\nlength = 1\n[[body]]\nlength = 2\n");
  for (const std::string key : {"body[0]length", "body[2].length", "body[0", "body[]", "body[0]]"}) {
    INFO(key);
    const SceneError error = error_of(text, {{key, "3", "--set " + key + "=3"}});
    CHECK(error.problems().size() == 1);
  }
  CHECK(parse_scene(text, "limits.toml", {{"body[1].length", "3", "--set"}}).bodies.at(1).body.length == 3.0);
}
