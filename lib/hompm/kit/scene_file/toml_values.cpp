#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include <hompm/kit/scene_file/toml_values.hpp>

namespace hompm::detail {
namespace {

constexpr int deepest = 3;  // of any key of a scene: initial.velocity.shape
constexpr std::size_t most_values = 100'000;

// toml++ bounds the nesting of brackets, but builds and destroys one table per dot of a dotted name by
// recursion, so that a line of 50,000 dots ends on the stack. Position of the first name with too many dots.
std::optional<std::pair<int, int>> overlong_name(std::string_view text) {
  constexpr int most_dots = 32;
  int line = 1;
  int column = 0;
  int dots = 0;
  for (const char character : text) {
    ++column;
    if (character == '\n') {
      ++line;
      column = 0;
    }
    if (character == '.') {
      if (++dots > most_dots) return std::pair{line, column};
    } else if (std::string_view("=,{}[]#\n").find(character) != std::string_view::npos) {
      dots = 0;
    }
  }
  return std::nullopt;
}

// A quoted key such as "scheme.cells" is one name; quoted in the path too, it is not mistaken for a dotted
// one.
std::string path_segment(std::string_view key) {
  const bool bare = !key.empty() && key.find_first_not_of(
                                        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                        "0123456789_-") == std::string_view::npos;
  return bare ? std::string(key) : toml_string(std::string(key));
}

Content content_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::boolean: return node.as_boolean()->get();
    case toml::node_type::integer: return node.as_integer()->get();
    case toml::node_type::floating_point: return node.as_floating_point()->get();
    case toml::node_type::string: return node.as_string()->get();
    case toml::node_type::table: return TomlTable{};
    case toml::node_type::array: return Array{};
    default: return Moment{};
  }
}

/// A number whose value is not what its text says: 1e-400 is not 0. `text` begins with it.
bool differs(double value, std::string_view text) {
  if (std::isnormal(value)) return false;
  std::size_t at = 0;
  while (at < text.size() && std::string_view("+-0123456789._").find(text[at]) != std::string_view::npos)
    ++at;
  const std::string_view digits = text.substr(0, at);
  if (std::isfinite(value)) return digits.find_first_of("123456789") != std::string_view::npos;
  return digits.find_first_of("0123456789") != std::string_view::npos;
}

/// What a number's text and value disagree on; a scene text by its lines.
class Literals {
 public:
  explicit Literals(std::string_view text) {
    for (std::size_t end = 0; end != std::string_view::npos; text.remove_prefix(end + 1)) {
      end = text.find('\n');
      lines_.push_back(text.substr(0, end));
      if (end == std::string_view::npos) break;
    }
  }
  /// Whether the value of a node is not what its text says.
  [[nodiscard]] bool out_of_range(const toml::node& node) const {
    const auto* value = node.as_floating_point();
    if (value == nullptr || std::isnormal(value->get())) return false;
    const toml::source_position& at = node.source().begin;
    std::string_view text = lines_.at(at.line - 1);
    for (toml::source_index column = 1; column < at.column && !text.empty();
         ++column)  // characters, not bytes
      do text.remove_prefix(1);
      while (!text.empty() && (static_cast<unsigned char>(text.front()) & 0xC0U) == 0x80U);
    return differs(value->get(), text);
  }

 private:
  std::vector<std::string_view> lines_;
};

class Flattener {
 public:
  Flattener(Said& said, std::string_view text) : said_(said), literals_(text) {}

  void add_table(const toml::table& table, const std::string& path, int depth) {
    for (const auto& [key, node] : table)
      add(node, join_path(path, path_segment(key.str())), path, std::string(key.str()), key.source(), depth);
  }

 private:
  void add(const toml::node& node, const std::string& path, const std::string& parent,
           const std::string& name, const toml::source_region& key, int depth) {
    if (literals_.out_of_range(node))
      throw SceneError(origin(node.source()),
                       '`' + printable(path) +
                           "` is too small or too large for a number: they are held in full from 2.2e-308 to "
                           "1.8e308, and 0");
    said_.values[path] = {content_of(node), parent, name, origin(key), origin(node.source())};
    if (depth == deepest) return;
    if (const toml::table* table = node.as_table()) add_table(*table, path, depth + 1);
    if (const toml::array* array = node.as_array();
        array != nullptr && (path == "effect" || path == "body" || path == "probe")) {
      // A body holds what else stands at the top.
      const int below = path == "body" ? 0 : depth + 1;
      std::size_t index = 0;
      for (const toml::node& element : *array)
        add(element, path + '[' + std::to_string(index++) + ']', path, name, element.source(), below);
    }
  }

  [[nodiscard]] Origin origin(const toml::source_region& region) const {
    return {said_.source, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
  }

  Said& said_;
  Literals literals_;
};

}  // namespace

const SaidValue* Said::find(const std::string& path) const {
  const auto entry = values.find(path);
  return entry == values.end() ? nullptr : &entry->second;
}

Origin Said::where(const std::string& path) const {
  for (std::string at = path; !at.empty(); at = parent_path(at)) {
    if (const SaidValue* value = find(at)) return value->value;
  }
  return {source, 0, 0};
}

std::string join_path(const std::string& parent, const std::string& name) {
  return parent.empty() ? name : parent + '.' + name;
}

std::string parent_path(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? "" : path.substr(0, dot);
}

std::string last_name(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? path : path.substr(dot + 1);
}

std::string list_path(const std::string& list, std::size_t index) {
  return list + '[' + std::to_string(index) + ']';
}

Said read_toml(const std::string& text, const std::string& source) {
  if (const auto position = overlong_name(text)) {
    throw SceneError(Origin{source, position->first, position->second}, "a name with more than 32 dots");
  }
  Said said{source, {}};
  try {
    Flattener(said, text).add_table(toml::parse(std::string_view(text), source), "", 1);
  } catch (const toml::parse_error& error) {
    const auto& at = error.source().begin;
    throw SceneError(Origin{source, static_cast<int>(at.line), static_cast<int>(at.column)},
                     printable(std::string(error.description()), 300));
  }
  if (said.values.size() > most_values)
    throw SceneError(Origin{source, 0, 0}, "there are " + std::to_string(said.values.size()) +
                                               " keys and tables; a scene has at most " +
                                               std::to_string(most_values));
  return said;
}

Content parse_value(const std::string& text) {
  if (!overlong_name(text)) {
    try {
      // More than one key means that the text was no value but a piece of a file.
      const std::string line = "value = " + text;
      const toml::table table = toml::parse(line);
      if (table.size() == 1 && !Literals(line).out_of_range(*table.get("value")))
        return content_of(*table.get("value"));
    } catch (const toml::parse_error&) {
      return text;
    }
  }
  return text;
}

}  // namespace hompm::detail
