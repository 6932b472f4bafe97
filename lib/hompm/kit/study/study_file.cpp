#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/scene_file/value_rule.hpp>
#include <hompm/kit/study/study.hpp>
#include <hompm/number.hpp>

namespace hompm::study {
namespace {

class Reader {
 public:
  explicit Reader(std::string path) : path_(std::move(path)) {}

  Study read(const toml::table& file) {
    Study study;
    for (const auto& [key, node] : file) {
      const std::string name(key.str());
      if (name == "case") {
        study.case_name = text(node, name);
      } else if (name == "variant") {
        study.variant = text(node, name);
      } else if (name == "scene") {
        study.scene_file = (std::filesystem::path(path_).parent_path() / text(node, name)).string();
      } else if (name == "set" && node.is_table()) {
        each(*node.as_table(), "", [&](const std::string& path, const toml::node& value) {
          if (const auto key_there = key_of(path, value))
            for (const std::string& one : values(value))
              study.settings.push_back({*key_there, one, origin(value).text()});
          if (value.is_array())
            report(value, "`" + detail::printable(path) + "` takes one value here; lists go into [[sweep]]");
        });
      } else if (name == "sweep" && node.is_array_of_tables()) {
        for (const toml::node& table : *node.as_array()) study.sweeps.push_back(sweep(*table.as_table()));
      } else {
        const std::string near = nearest(name, {"case", "variant", "scene", "set", "sweep"});
        report(node, "`" + detail::printable(name) + "` has no place in a study" +
                         (near.empty() || near == name ? ": it holds case, variant, scene, [set], [[sweep]]"
                                                       : "; did you mean `" + near + "`?"));
      }
    }
    if (study.case_name.empty() == study.scene_file.empty())
      problems_.push_back({Origin{path_}, "a study names either a `case` or a `scene`"});
    if (!problems_.empty()) throw SceneError(problems_);
    if (study.sweeps.empty()) study.sweeps = usual_sweeps();
    return study;
  }

 private:
  [[nodiscard]] Origin origin(const toml::node& node) const {
    const auto begin = node.source().begin;
    return {path_, static_cast<int>(begin.line), static_cast<int>(begin.column)};
  }
  void report(const toml::node& node, std::string message) {
    problems_.push_back({origin(node), std::move(message)});
  }

  std::string text(const toml::node& node, const std::string& name) {
    if (const auto said = node.value_exact<std::string>()) return *said;
    report(node, "`" + name + "` must be a text");
    return "";
  }

  /// The values below a table, with their dotted paths: keys may be written "scheme.cells" or as tables.
  void each(const toml::table& table, const std::string& above,
            const std::function<void(const std::string&, const toml::node&)>& take) {
    for (const auto& [key, node] : table) {
      const std::string path = above + std::string(key.str());
      if (const auto* inner = node.as_table())
        each(*inner, path + ".", take);
      else
        take(path, node);
    }
  }

  std::optional<std::string> key_of(const std::string& path, const toml::node& node) {
    try {
      return full_key(path, origin(node).text());
    } catch (const SceneError& error) {
      problems_.insert(problems_.end(), error.problems().begin(), error.problems().end());
      return std::nullopt;
    }
  }

  std::vector<std::string> values(const toml::node& node) {
    std::vector<std::string> found;
    const auto add = [&](const toml::node& one) {
      std::string said;
      if (const auto whole = one.value_exact<std::int64_t>())
        said = std::to_string(*whole);
      else if (const auto number = one.value_exact<double>(); number && std::isfinite(*number))
        said = to_text(*number);
      else if (const auto flag = one.value_exact<bool>())
        said = *flag ? "true" : "false";
      else if (const auto word = one.value_exact<std::string>())
        said = *word;
      try {
        found.push_back(canonical_value(said, origin(one).text()));
      } catch (const SceneError& error) {
        problems_.insert(problems_.end(), error.problems().begin(), error.problems().end());
      }
    };
    if (const auto* array = node.as_array())
      for (const toml::node& one : *array) add(one);
    else
      add(node);
    if (found.empty()) report(node, "a key needs at least one value");
    return found;
  }

  Sweep sweep(const toml::table& table) {
    Sweep axes;
    each(table, "", [&](const std::string& path, const toml::node& node) {
      if (const auto key = key_of(path, node)) axes.push_back({*key, values(node), origin(node).text()});
    });
    return axes;
  }

  std::string path_;
  std::vector<Problem> problems_;
};

std::string quoted_key(const std::string& key) { return detail::toml_string(short_key(key)); }

/// Numbers and truth values as they are, words in quotes.
std::string toml_value(const std::string& value) {
  const bool number = value.find_first_not_of("0123456789.+-e") == std::string::npos;
  return number || value == "true" || value == "false" ? value : detail::toml_string(value);
}

}  // namespace

Study read_study(const std::string& path) {
  const std::string text = read_file(path);
  try {
    return Reader(path).read(toml::parse(text, path));
  } catch (const toml::parse_error& error) {
    const auto begin = error.source().begin;
    throw SceneError(Origin{path, static_cast<int>(begin.line), static_cast<int>(begin.column)},
                     std::string(error.description()));
  }
}

std::string study_text(const Study& study) {
  std::string text;
  const auto line = [&](const char* key, const std::string& value) {
    if (!value.empty()) text += std::string(key) + " = " + detail::toml_string(value) + "\n";
  };
  line("case", study.case_name);
  line("variant", study.variant);
  line("scene", study.scene_file);
  if (!study.settings.empty()) text += "\n[set]\n";
  for (const auto& [key, value, where] : study.settings)
    text += quoted_key(key) + " = " + toml_value(value) + "\n";
  for (const Sweep& sweep : study.sweeps) {
    text += "\n[[sweep]]\n";
    for (const Axis& axis : in_order(sweep)) {
      std::string list;
      for (const std::string& value : axis.values) list += (list.empty() ? "" : ", ") + toml_value(value);
      text += quoted_key(axis.key) + " = [" + list + "]\n";
    }
  }
  return text;
}

}  // namespace hompm::study
