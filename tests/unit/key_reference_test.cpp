// What is told of keys is what the reader keeps to.
#include <algorithm>
#include <charconv>
#include <string>
#include <vector>

#include <hompm/effects/registry.hpp>
#include <hompm/kit/scene_file/reader.hpp>

#include "support/catch.hpp"

using namespace hompm;

namespace {

double number_in(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  REQUIRE(error == std::errc{});
  return value;
}

struct Values {
  std::vector<std::string> valid;
  std::vector<std::string> invalid;
};

/// Values on each side of the bounds in "> 0", "≥ 0", "≤ 7", "1 … 5", or words.
Values around(const SceneKey& key) {
  if (key.type == "word") return {key.words, {"\"some other word\"", "1"}};
  if (key.type == "boolean") return {{"true", "false"}, {"0", "\"yes\""}};
  if (key.type == "text") return {{"\"any\""}, {"1", "true"}};
  const auto text = [&](double value) {
    return key.type == "integer" ? std::to_string(static_cast<std::int64_t>(value)) : std::to_string(value);
  };
  Values values{{}, {"\"word\"", "nan", "inf", "-inf"}};
  if (key.type == "integer") values.invalid.emplace_back("1.5");
  const auto after = [&](const std::string& sign) { return number_in(key.range.substr(sign.size())); };
  if (const std::string to = " … "; key.range.find(to) != std::string::npos) {
    const double least = number_in(key.range);
    const double most = number_in(key.range.substr(key.range.find(to) + to.size()));
    values.valid = {text(least), text(most)};
    values.invalid.insert(values.invalid.end(), {text(least - 1.0), text(most + 1.0)});
  } else if (key.range.starts_with("> ")) {
    values.valid = {"1e-300"};
    values.invalid.insert(values.invalid.end(), {text(after("> ")), "-1e-300"});
  } else if (key.range.starts_with("≥ ")) {
    values.valid = {text(after("≥ "))};
    values.invalid.emplace_back("-1e-300");
  } else if (key.range.starts_with("≤ ")) {
    values.valid = {text(after("≤ "))};
    values.invalid.push_back(text(after("≤ ") + 1.0));
  } else {
    REQUIRE(key.range.empty());
  }
  return values;
}

/// Whether a scene of nothing but this is refused because of this.
bool refuses(const std::string& text, const Override& said, const std::string& label) {
  try {
    parse_scene(text, "keys.toml", {said});
  } catch (const SceneError& error) {
    return std::ranges::any_of(error.problems(), [&](const Problem& problem) {
      return problem.origin.source == said.option && problem.message.starts_with(label + " must be ");
    });
  }
  return false;
}

void check_values(const SceneKey& key, const std::string& text, const std::string& path,
                  const std::string& label) {
  INFO(path << ": " << key.range);
  const auto [valid, invalid] = around(key);
  const bool bounded_elsewhere = !key.condition.empty();
  for (const std::string& value : valid) {
    INFO(value);
    CHECK((bounded_elsewhere || !refuses(text, {path, value, "--set"}, label)));
  }
  for (const std::string& value : invalid) {
    INFO(value);
    CHECK(refuses(text, {path, value, "--set"}, label));
  }
}

}  // namespace

TEST_CASE("A key takes the values it is told to take, and no others") {
  for (const SceneKey& key : scene_keys()) check_values(key, "", key.path, "`" + key.path + "`");
}

TEST_CASE("A parameter of an effect takes the values it is told to take, and no others") {
  for (const EffectType& effect : effect_catalogue())
    for (const SceneKey& key : parameter_keys(effect)) {
      CHECK_FALSE(key.meaning.empty());
      CHECK(key.required == key.standard.empty());
      check_values(key, "[[effect]]\ntype = \"" + effect.name + "\"\n", "effect[0]." + key.path,
                   "`" + key.path + "` of the effect " + effect.name);
    }
}

TEST_CASE("A key that must be given is missed, any other not") {
  const auto missed = [](const std::string& text, const std::string& path) {
    try {
      parse_scene(text, "keys.toml", {});
    } catch (const SceneError& error) {
      return std::ranges::any_of(error.problems(), [&](const Problem& problem) {
        return problem.message.starts_with("`" + path + "` is missing");
      });
    }
    return false;
  };
  for (const SceneKey& key : scene_keys()) {
    INFO(key.path);
    if (key.optional_table.empty()) {
      CHECK(missed("", key.path) == key.required);
    } else {
      CHECK_FALSE(missed("", key.path));
      CHECK(missed("[" + key.optional_table + "]\nsomething = 1\n", key.path) == key.required);
    }
  }
}
