#include <algorithm>
#include <charconv>
#include <cmath>

#include <hompm/number.hpp>
#include <hompm/scene_file/content.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/study/study.hpp>

namespace hompm::study {
namespace {

const std::string prefix = "scheme.";

std::string with_underscores(std::string text) {
  std::replace(text.begin(), text.end(), '-', '_');
  return text;
}

bool is_key(const std::string& key) {
  const auto& keys = scene_keys();
  return std::any_of(keys.begin(), keys.end(), [&](const SceneKey& known) { return known.path == key; });
}

}  // namespace

std::string full_key(const std::string& said, const std::string& where) {
  // Which effects and parameters there are depends on the scene; its reader tells.
  if (said == "scheme") return prefix + "name";
  if (said.starts_with("effect.") || said.starts_with("effect[")) return said;
  std::string key = with_underscores(said);
  if (is_key(key)) return key;
  if (is_key(prefix + key)) return prefix + key;
  std::vector<std::string> candidates{"scheme"};
  for (const SceneKey& known : scene_keys()) candidates.push_back(short_key(known.path));
  const std::string near = nearest(key, candidates);
  throw SceneError(Origin{where}, "no scene has a key `" + detail::printable(said) + "`" +
                                      (near.empty() ? "" : "; did you mean `" + near + "`?"));
}

std::string short_key(const std::string& key) {
  if (key == prefix + "name") return "scheme";
  return key.starts_with(prefix) ? key.substr(prefix.size()) : key;
}

std::string canonical_value(const std::string& said, const std::string& where) {
  const char* const end = said.data() + said.size();
  long long whole = 0;
  if (const auto [stop, error] = std::from_chars(said.data(), end, whole);
      error == std::errc{} && stop == end)
    return std::to_string(whole);
  double number = 0.0;
  if (const auto [stop, error] = std::from_chars(said.data(), end, number);
      error == std::errc{} && stop == end && std::isfinite(number))
    return to_text(number);
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.' || c == '+';
  };
  if (said.empty() || !std::all_of(said.begin(), said.end(), plain))
    throw SceneError(Origin{where}, "`" + detail::printable(said) + "` is neither a number nor a word");
  return said;
}

}  // namespace hompm::study
