// Values on their way into a Scene and out of it.
#include <algorithm>
#include <limits>

#include <hompm/scene_file/keys.hpp>

namespace hompm::detail {
namespace {

// The words of an enumeration stand in the key table in the order of its enumerators.
template <class Enumeration>
Enumeration enumerator(const std::vector<std::string>& words, const std::string& word) {
  std::size_t index = 0;
  while (words.at(index) != word) ++index;
  return static_cast<Enumeration>(index);
}

// A key without a range of its own is checked after the reading, against others: out of range stays out of
// range.
int saturated(std::int64_t value) {
  using Limits = std::numeric_limits<int>;
  return static_cast<int>(std::clamp<std::int64_t>(value, Limits::min(), Limits::max()));
}

struct Storer {
  const KeyRow& row;
  const Content& value;

  void operator()(double* slot) const { *slot = std::get<double>(value); }
  void operator()(int* slot) const { *slot = saturated(std::get<std::int64_t>(value)); }
  void operator()(bool* slot) const { *slot = std::get<bool>(value); }
  void operator()(std::string* slot) const { *slot = std::get<std::string>(value); }
  void operator()(std::optional<double>* slot) const { *slot = std::get<double>(value); }
  template <class Enumeration>
  void operator()(Enumeration* slot) const {
    *slot = enumerator<Enumeration>(row.rule.words, std::get<std::string>(value));
  }
};

struct Loader {
  const KeyRow& row;

  std::string operator()(const double* slot) const { return toml_number(*slot); }
  std::string operator()(const int* slot) const { return std::to_string(*slot); }
  std::string operator()(const bool* slot) const { return *slot ? "true" : "false"; }
  std::string operator()(const std::string* slot) const { return toml_string(*slot); }
  std::string operator()(const std::optional<double>* slot) const { return *slot ? toml_number(**slot) : ""; }
  template <class Enumeration>
  std::string operator()(const Enumeration* slot) const {
    return toml_string(row.rule.words.at(static_cast<std::size_t>(*slot)));
  }
};

}  // namespace

void store(const KeyRow& row, const Content& value, Scene& scene) {
  std::visit(Storer{row, value}, row.slot(scene));
}

void copy_value(const KeyRow& row, Scene& from, Scene& to) {
  std::visit([&](auto* slot) { *slot = *std::get<decltype(slot)>(row.slot(from)); }, row.slot(to));
}

std::string load_text(const KeyRow& row, Scene& scene) { return std::visit(Loader{row}, row.slot(scene)); }

}  // namespace hompm::detail
