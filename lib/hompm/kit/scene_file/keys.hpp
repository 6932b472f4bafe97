// The table of keys: what a scene may say outside [[effect]], and where in a Scene it is kept. Reading,
// checking, writing and the reference documentation all follow it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <hompm/kit/scene_file/value_rule.hpp>

namespace hompm::detail {

/// The member of a Scene that holds the value of a key.
using Slot =
    std::variant<double*, int*, bool*, std::string*, std::optional<double>*, End*, Kinematics*, Basis*,
                 Formulation*, Quadrature*, MassForm*, VelocityProjection*, Sequence*, Transfer*,
                 PositionUpdate*, StressUpdate*, TimeIntegrator*, FreeEnd*, Conserve*, EssentialConditions*>;

enum class Absent {
  missing,    ///< an error
  standard,   ///< the default is `KeyRow::standard`, TOML text
  seldom,     ///< the same, and the default is not written
  of_scheme,  ///< follows from the row of the table of schemes; with another scheme said on the command line
              ///< the file's is kept only where it suits that
  derived,    ///< follows from other keys; `KeyRow::standard` says how, and `complete` in reading.hpp does it
};

struct KeyRow {
  std::string path;
  ValueRule rule;
  Absent absent;
  std::string standard;
  std::string condition;  ///< what other keys demand of it beside the rule, in words; "" for nothing
  std::string meaning;
  std::function<Slot(Scene&)> slot;
};

/// Of all bodies together; a key of its own would be out of range by another.
constexpr std::int64_t most_particles = 100'000'000;

/// All keys, in the order in which they are written.
const std::vector<KeyRow>& key_table();

/// The row at `path`, or null.
const KeyRow* find_key(const std::string& path);

/// A table of keys that may be left out; without keys it counts as left out.
struct OptionalTable {
  std::string_view path;
  bool (*present)(const Scene&);
  void (*create)(Scene&);
};

/// The row of the table at `path`, or null where the table is not optional.
const OptionalTable* find_optional_table(const std::string& path);

/// Whether some key lies below `path`.
bool is_table(const std::string& path);

/// Names of the keys and tables in the table at `path`, without the path.
std::vector<std::string> names_in(const std::string& path);

/// Stores a value that the row's rule has accepted.
void store(const KeyRow& row, const Content& value, Scene& scene);

/// Gives `to` the value that `from` has.
void copy_value(const KeyRow& row, Scene& from, Scene& to);

/// The value as TOML text; "" where there is none.
std::string load_text(const KeyRow& row, Scene& scene);

}  // namespace hompm::detail
