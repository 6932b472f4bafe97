// What the command line says in place of the file.
#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <hompm/kit/scene_file/keys.hpp>
#include <hompm/kit/scene_file/reading.hpp>
#include <hompm/scheme/scheme.hpp>

namespace hompm::detail {
namespace {

Origin origin_of(const Override& said) { return {printable(said.option, said.option.size()), 0, 0}; }

std::size_t effect_count(const Said& said) {
  std::size_t count = 0;
  while (said.find(effect_path(count)) != nullptr) ++count;
  return count;
}

std::string type_of(const Said& said, std::size_t index) {
  const SaidValue* type = said.find(effect_path(index) + ".type");
  const auto* name = type != nullptr ? std::get_if<std::string>(&type->content) : nullptr;
  return name != nullptr ? *name : "";
}

// The index in "effect[2]", or of the first effect of the type in "effect.gravity".
std::optional<std::size_t> effect_index(const Said& said, const std::string& which) {
  const std::size_t count = effect_count(said);
  if (which.starts_with('[') && which.ends_with(']')) {
    std::size_t index = count;
    const char* end = which.data() + which.size() - 1;
    const auto [stop, error] = std::from_chars(which.data() + 1, end, index);
    if (error == std::errc{} && stop == end && index < count) return index;
    return std::nullopt;
  }
  for (std::size_t index = 0; index < count; ++index) {
    if ('.' + type_of(said, index) == which) return index;
  }
  return std::nullopt;
}

std::string effects_there(const Said& said) {
  std::vector<std::string> types;
  for (std::size_t index = 0; index < effect_count(said); ++index) types.push_back(type_of(said, index));
  return types.empty() ? "it has no effects" : "its effects: " + listed(types);
}

// "effect.gravity.acceleration" and "effect[0].acceleration" as "effect[0].acceleration"; reports an effect
// that the scene does not have.
std::optional<std::string> resolved(Reading& reading, const Override& said) {
  const bool by_type = said.key.starts_with("effect.");
  if (!by_type && !said.key.starts_with("effect[") && said.key != "effect") return said.key;
  const std::string rest = said.key.substr(std::string("effect").size());
  const std::size_t dot = rest.find('.', by_type ? 1 : 0);
  const Origin origin = origin_of(said);
  if (dot == std::string::npos || dot + 1 == rest.size()) {
    reading.report(origin, '`' + printable(said.key) +
                               "` names no parameter of an effect; write it as effect.gravity.acceleration");
    return std::nullopt;
  }
  const std::string which = rest.substr(0, dot);
  const auto index = effect_index(reading.said, which);
  if (!index) {
    reading.report(origin, "the scene has no effect `" +
                               printable(by_type ? which.substr(1) : "effect" + which) + "`; " +
                               effects_there(reading.said));
    return std::nullopt;
  }
  return effect_path(*index) + rest.substr(dot);
}

/// A scene that says this, of its effects nothing.
Reading probe_of(Said said) {
  const SaidValue* bodies = said.find("body");
  if (bodies != nullptr && std::holds_alternative<Array>(bodies->content) && said.find("body[0]") != nullptr)
    said = said_of_body(said, 0);
  Reading probe{.said = std::move(said)};
  read_keys(probe);
  complete(probe);
  return probe;
}

/// Another scheme takes the place of the file's, `owner`. What the file says of how it is discretised and the
/// owner is by itself goes with the owner; of the rest what the new scheme can take is kept, and what it
/// cannot is told.
void keep_what_suits(Reading& reading, const SaidValue* owner, const SaidValue& wish,
                     const std::map<std::string, SaidValue>& wishes) {
  auto& values = reading.said.values;
  std::vector<std::pair<const KeyRow*, SaidValue>> from_file;
  for (const KeyRow& row : key_table()) {
    const auto said = values.find(row.path);
    if (row.absent != Absent::of_scheme || wishes.contains(row.path) || said == values.end()) continue;
    from_file.emplace_back(&row, said->second);
    values.erase(said);
  }
  if (from_file.empty()) return;
  const std::size_t problems = probe_of(reading.said).problems.size();
  Said before = reading.said;
  before.values.erase("scheme.name");
  if (owner != nullptr) before.values["scheme.name"] = *owner;
  Scene own = probe_of(std::move(before)).scene;
  for (const auto& [row, value] : from_file) {
    // A degree is said to be had.
    const bool is_own =
        accepted(row->rule, parse_value(load_text(*row, own))) == accepted(row->rule, value.content);
    if (is_own && row->path != "scheme.degree") continue;
    values[row->path] = value;
    const std::vector<Problem> with = probe_of(reading.said).problems;
    if (with.size() <= problems) continue;
    values.erase(row->path);
    reading.scene.warnings.push_back({"dropped-key", wish.key.source + " drops `" + row->path +
                                                         "` = " + shown(value.content) + " (" +
                                                         value.key.text() + "): " + with.back().message});
  }
}

/// `--probe 0.5`, `--probe left`, `--probe x=0.5`: a [[probe]] behind those of the file.
void add_probe(Reading& reading, const Override& said) {
  auto& values = reading.said.values;
  std::size_t index = 0;
  while (values.contains(list_path("probe", index))) ++index;
  const Origin origin = origin_of(said);
  const bool in_space = said.value.starts_with("x=");
  const Content place = parse_value(in_space ? said.value.substr(2) : said.value);
  const std::string name = std::holds_alternative<std::string>(place) && !in_space ? "end"
                           : in_space                                              ? "x"
                                                                                   : "X";
  const std::string path = list_path("probe", index);
  values.try_emplace("probe", SaidValue{Array{}, "", "probe", origin, origin});
  values[path] = {TomlTable{}, "probe", "probe", origin, origin};
  values[join_path(path, name)] = {place, path, name, origin, origin};
}

}  // namespace

void apply_overrides(Reading& reading, const std::vector<Override>& overrides) {
  std::map<std::string, SaidValue> said;
  for (const Override& wish : overrides) {
    if (wish.key == "probe") {
      add_probe(reading, wish);
      continue;
    }
    const auto path = resolved(reading, wish);
    if (!path) continue;
    const Origin origin = origin_of(wish);
    if (const auto before = said.find(*path); before != said.end()) {
      reading.report(origin, '`' + printable(*path) + "` is said twice, here and by " +
                                 before->second.key.source + ": give it once");
      continue;
    }
    const Content content = parse_value(wish.value);
    if (std::holds_alternative<TomlTable>(content) || std::holds_alternative<Array>(content)) {
      reading.report(origin, '`' + printable(wish.key) + "` takes one value, not " + shown(content));
    } else {
      said[*path] = {content, parent_path(*path), last_name(*path), origin, origin};
    }
  }
  auto& values = reading.said.values;
  const std::vector<std::string> steps{"scheme.time_step", "scheme.courant", "scheme.step_fraction"};
  for (const std::string& step : steps) {
    if (!said.contains(step)) continue;
    for (const std::string& other : steps) values.erase(other);
  }
  std::optional<SaidValue> owner;
  if (const SaidValue* name = reading.said.find("scheme.name")) owner = *name;
  for (const auto& [path, value] : said) values[path] = value;
  const auto wish = said.find("scheme.name");
  if (wish == said.end()) return;
  const Content before = owner ? owner->content : parse_value(find_key("scheme.name")->standard);
  if (wish->second.content != before) keep_what_suits(reading, owner ? &*owner : nullptr, wish->second, said);
}

}  // namespace hompm::detail
