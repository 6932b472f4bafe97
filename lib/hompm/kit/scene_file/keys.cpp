#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include <hompm/kit/scene_file/keys.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/scene_file/toml_values.hpp>
#include <hompm/materials/material.hpp>
#include <hompm/scheme/scheme.hpp>

namespace hompm {
namespace detail {
namespace {

constexpr double anything = std::numeric_limits<double>::infinity();

ValueRule number(const std::string& unit, double minimum = -anything, double maximum = anything) {
  return {.type = ValueType::number, .unit = unit, .minimum = minimum, .maximum = maximum};
}

ValueRule positive(const std::string& unit) {
  return {.type = ValueType::number, .unit = unit, .minimum = 0.0, .minimum_excluded = true};
}

ValueRule whole(double minimum, double maximum) {
  return {.type = ValueType::integer, .minimum = minimum, .maximum = maximum};
}

ValueRule word(const std::vector<std::string>& words) { return {.type = ValueType::word, .words = words}; }

ValueRule any(ValueType type) { return {.type = type}; }

std::vector<std::string> scheme_names() {
  std::vector<std::string> names;
  for (const Scheme& scheme : scheme_table()) names.push_back(scheme.name);
  return names;
}

/// "1 with classical, ugimp; 2 with bspline", by what `of_scheme` says of each.
template <class Word>
std::string by_scheme(Word of_scheme) {
  std::vector<std::pair<std::string, std::string>> names;  // by what is said
  for (const Scheme& scheme : scheme_table()) {
    const auto same =
        std::ranges::find(names, of_scheme(scheme), &std::pair<std::string, std::string>::first);
    if (same == names.end())
      names.emplace_back(of_scheme(scheme), scheme.name);
    else
      same->second += ", " + scheme.name;
  }
  std::string text;
  for (const auto& [said, of] : names)
    text.append(text.empty() ? "" : "; ").append(said).append(" with ").append(of);
  return text;
}

std::string default_degrees() {
  return by_scheme([](const Scheme& scheme) { return std::to_string(scheme.default_degree); });
}

std::string degree_ranges() {
  return by_scheme([](const Scheme& scheme) {
    return range_text(
        whole(static_cast<double>(scheme.lowest_degree), static_cast<double>(scheme.highest_degree)));
  });
}

std::string relaxation_rates() {
  std::string names;
  for (const Scheme& scheme : scheme_table())
    if (scheme.relaxes) names += (names.empty() ? "" : ", ") + scheme.name;
  return "π c / length with " + names + "; else 0";
}

std::vector<std::string> law_names() {
  std::vector<std::string> names;
  for (const MaterialLaw& law : material_laws()) names.push_back(law.name);
  return names;
}

/// What laws ask for beside density and Young's modulus, behind those.
void add_law_parameters(std::vector<KeyRow>& table) {
  auto behind = std::ranges::find(table, "material.youngs_modulus", &KeyRow::path) + 1;
  for (const MaterialLaw& law : material_laws())
    for (const LawParameter& parameter : law.parameters)
      behind = 1 + table.insert(behind, {.path = "material." + parameter.name,
                                         .rule = {.type = ValueType::number,
                                                  .unit = parameter.unit,
                                                  .minimum = parameter.minimum,
                                                  .minimum_excluded = parameter.minimum_excluded},
                                         .absent = Absent::derived,
                                         .standard = "",
                                         .condition = "with the law " + law.name + ", and only there",
                                         .meaning = parameter.meaning,
                                         .slot = [name = parameter.name](Scene& scene) -> Slot {
                                           return &scene.material.parameters[name];
                                         }});
}

std::vector<KeyRow> make_key_table() {
  using enum Absent;
  const ValueRule text = any(ValueType::text);
  const ValueRule end = word({"fixed", "free"});  // in the order of the enumeration
  const std::string own = "the scheme's own";
  const std::string one_of = "give exactly one of time_step, courant, step_fraction";
  const std::string bound = "else the run ends with exit code 3";
  const std::string largest = "the most that `errors.bound` of run.json may say of the ";
  const std::string particles = "at most " + std::to_string(most_particles) + " particles in all";
  return {
      {"case", text, derived, "name of the file", "no / and no control character",
       "what the scene is called; part of the name of the output folder",
       [](Scene& s) { return &s.case_name; }},
      {"variant", text, standard, "\"\"", "as case", "which of several scenes of one case",
       [](Scene& s) { return &s.variant; }},
      {"title", text, standard, "\"\"", "", "one line about the scene", [](Scene& s) { return &s.title; }},
      {"end_time", positive("s"), missing, "", "", "when the run ends", [](Scene& s) { return &s.end_time; }},
      {"kinematics", word({"infinitesimal", "finite"}), derived, "as the law demands",
       "infinitesimal with the law linear, finite with the others", "whether positions and volumes change",
       [](Scene& s) { return &s.kinematics; }},

      {"body.length", positive("m"), missing, "", "", "length of the undeformed body",
       [](Scene& s) { return &s.body.length; }},
      {"body.start", number("m"), derived, "at the origin, 0", "", "where its left end is at t = 0",
       [](Scene& s) { return &s.body.start; }},

      {"material.law", word(law_names()), missing, "", "", "constitutive law",
       [](Scene& s) { return &s.material.law; }},
      {"material.density", positive("kg/m³"), missing, "", "", "density of the undeformed material",
       [](Scene& s) { return &s.material.density; }},
      {"material.youngs_modulus", positive("Pa"), missing, "", "", "stiffness of the undeformed material",
       [](Scene& s) { return &s.material.youngs_modulus; }},

      {"initial.velocity.shape", word({"sine", "uniform", "linear"}), missing, "", "",
       "velocity at the start: amplitude · sin(mode π X/length), amplitude, amplitude + gradient · X; X from "
       "the left end",
       [](Scene& s) { return &s.initial_velocity->shape; }},
      {"initial.velocity.amplitude", number("m/s"), missing, "", "", "of the velocity at the start",
       [](Scene& s) { return &s.initial_velocity->amplitude; }},
      {"initial.velocity.mode", whole(1.0, 1e6), standard, "1", "", "half waves over the body",
       [](Scene& s) { return &s.initial_velocity->mode; }},
      {"initial.velocity.gradient", number("1/s"), derived, "", "with the shape linear, and only there",
       "of the velocity along X", [](Scene& s) { return &s.initial_velocity->gradient; }},

      {"initial.displacement.shape", word({"sine", "uniform", "linear"}), missing, "", "zero at fixed ends",
       "displacement at the start, from which stretch and stress follow: as the velocity",
       [](Scene& s) { return &s.initial_displacement->shape; }},
      {"initial.displacement.amplitude", number("m"), missing, "", "", "of the displacement at the start",
       [](Scene& s) { return &s.initial_displacement->amplitude; }},
      {"initial.displacement.mode", whole(1.0, 1e6), standard, "1", "", "half waves over the body",
       [](Scene& s) { return &s.initial_displacement->mode; }},
      {"initial.displacement.gradient", number(""), derived, "", "with the shape linear, and only there",
       "of the displacement along X: the strain", [](Scene& s) { return &s.initial_displacement->gradient; }},

      {"ends.left", end, standard, "\"fixed\"", "", "the end at X = 0",
       [](Scene& s) { return &s.ends.left; }},
      {"ends.right", end, standard, "\"fixed\"", "", "the end at X = length",
       [](Scene& s) { return &s.ends.right; }},

      {"grid.from", number("m"), derived, "by scheme.margin_cells",
       "degree + 1 cells beyond a free left end, or more",
       "the grid reaches from here at least: for bodies that fly", [](Scene& s) { return &s.grid.from; }},
      {"grid.to", number("m"), derived, "by scheme.margin_cells",
       "degree + 1 cells beyond a free right end, or more", "the grid reaches up to here at least",
       [](Scene& s) { return &s.grid.to; }},

      {"rest.speed", positive("m/s"), missing, "", "",
       "the run also ends once no particle has moved faster for the time a wave takes through the body and "
       "back, while no load changed and no gap was about to close",
       [](Scene& s) { return &s.rest->speed; }},
      {"rest.earliest", number("s", 0.0), derived, "the start", "",
       "before which the run does not end, whatever is at rest", [](Scene& s) { return &s.rest->earliest; }},

      {"scheme.name", word(scheme_names()), standard, "\"tielen2017\"", "", "how the scene is discretised",
       [](Scene& s) { return &s.scheme.name; }},
      {"scheme.degree", any(ValueType::integer), of_scheme, default_degrees(), degree_ranges(),
       "degree of the splines", [](Scene& s) { return &s.scheme.degree; }},
      {"scheme.cells", whole(1.0, 1e7), missing, "", particles, "grid cells over the body",
       [](Scene& s) { return &s.scheme.cells; }},
      {"scheme.particles_per_cell", whole(1.0, 1000.0), missing, "", particles,
       "particles in each cell of the body", [](Scene& s) { return &s.scheme.particles_per_cell; }},
      {"scheme.margin_cells", whole(-anything, 1e7), of_scheme, "a quarter of cells, at least degree + 2",
       "≥ degree + 1", "grid cells beyond a free end", [](Scene& s) { return &s.scheme.margin_cells; }},
      {"scheme.time_step", positive("s"), derived, "", one_of,
       "the step, shortened so that a whole number of them ends at end_time",
       [](Scene& s) { return &s.scheme.time_step; }},
      {"scheme.courant", positive(""), derived, "", one_of,
       "the step over the time a wave takes through a cell, c Δt/h",
       [](Scene& s) { return &s.scheme.courant; }},
      {"scheme.step_fraction", positive(""), derived, "", one_of,
       "the step over the largest stable step of the scheme",
       [](Scene& s) { return &s.scheme.step_fraction; }},
      {"scheme.basis",
       word({"splines", "uniform-domains", "contiguous-domains", "carried-domains", "smoothed-gradients"}),
       of_scheme, own, "", "functions between particles and grid",
       [](Scene& s) { return &s.scheme.choices.basis; }},
      {"scheme.formulation", word({"updated-lagrangian", "total-lagrangian"}), of_scheme, own, "",
       "the basis on the present or on the reference configuration",
       [](Scene& s) { return &s.scheme.choices.formulation; }},
      {"scheme.quadrature",
       word({"particles", "reconstructed", "reconstructed-exact", "moving-least-squares",
             "taylor-least-squares", "mixed"}),
       of_scheme, own, "", "where stress is integrated: [quadratures](schemes.md#quadratures)",
       [](Scene& s) { return &s.scheme.choices.quadrature; }},
      {"scheme.acceleration_mass", word({"lumped", "consistent"}), of_scheme, own, "",
       "by which forces are divided", [](Scene& s) { return &s.scheme.choices.acceleration_mass; }},
      {"scheme.velocity_projection", word({"lumped", "consistent", "least-squares"}), of_scheme, own, "",
       "particle velocity to the grid", [](Scene& s) { return &s.scheme.choices.velocity_projection; }},
      {"scheme.sequence", word({"musl", "usl", "usf"}), of_scheme, own, "",
       "stress after the updated particle velocities went to the grid, after the forces, before them",
       [](Scene& s) { return &s.scheme.choices.sequence; }},
      {"scheme.position_update", word({"after-projection", "before-projection"}), seldom,
       "\"after-projection\"", "before-projection with the sequence musl",
       "the grid velocity that moves particles: that of their updated velocities, or of the grid's own "
       "update",
       [](Scene& s) { return &s.scheme.choices.position_update; }},
      {"scheme.transfer", word({"flip", "pic", "apic", "xpic"}), of_scheme, own, "",
       "what particles take back from the grid: the change of velocity, the velocity, that and its gradient, "
       "the change less what the grid does not see",
       [](Scene& s) { return &s.scheme.choices.transfer; }},
      {"scheme.flip_fraction", number("", 0.0, 1.0), of_scheme, toml_number(SchemeChoices{}.flip_fraction),
       "with the transfer flip",
       "part of the change of velocity in what particles take back; the rest is the velocity",
       [](Scene& s) { return &s.scheme.choices.flip_fraction; }},
      {"scheme.xpic_order", whole(1.0, 20.0), of_scheme, std::to_string(SchemeChoices{}.xpic_order),
       "with the transfer xpic", "how often its filter is applied; 1 is pic",
       [](Scene& s) { return &s.scheme.choices.xpic_order; }},
      {"scheme.stress_update", word({"incremental", "from-stretch", "from-positions"}), of_scheme, own, "",
       "by increments, of the stretch that is summed up, or of the stretch of the positions",
       [](Scene& s) { return &s.scheme.choices.stress_update; }},
      {"scheme.time_integrator", word({"euler-cromer", "leapfrog", "blanes-moan"}), of_scheme, own, "",
       "of order 1, 2, 4", [](Scene& s) { return &s.scheme.choices.time_integrator; }},
      {"scheme.free_end", word({"particles", "cut-span", "extension"}), of_scheme, own, "",
       "how a partly filled span is treated: nothing special, integrated up to the end, its functions tied "
       "to the others too",
       [](Scene& s) { return &s.scheme.choices.free_end; }},
      {"scheme.markers", any(ValueType::boolean), of_scheme, own, "",
       "massless particles at the ends of the body", [](Scene& s) { return &s.scheme.choices.markers; }},
      {"scheme.conserve", word({"nothing", "cell-mass", "momentum", "cell-momentum"}), of_scheme, own, "",
       "what the reconstructed density keeps exactly, and with cell-momentum the momentum",
       [](Scene& s) { return &s.scheme.choices.conserve; }},
      {"scheme.essential_conditions", word({"in-system", "after-solution"}), seldom, "\"in-system\"", "",
       "fixed functions are left out of a system with a consistent matrix, or set to zero after its solution",
       [](Scene& s) { return &s.scheme.choices.essential_conditions; }},
      {"scheme.relaxation_rate", number("1/s", 0.0), of_scheme, relaxation_rates(), "",
       "at which displacements that project to nothing on the grid decay; 0 leaves them",
       [](Scene& s) { return &s.scheme.relaxation_rate; }},
      {"scheme.allow_unstable", any(ValueType::boolean), standard, "false", "",
       "run with a step above the critical one", [](Scene& s) { return &s.scheme.allow_unstable; }},

      {"output.snapshots", whole(1.0, 10000.0), standard, "10", "",
       "times at which particles are written after the start", [](Scene& s) { return &s.output.snapshots; }},
      {"output.history", whole(1.0, 1e6), standard, "100", "", "rows of the history after the start",
       [](Scene& s) { return &s.output.history; }},

      {"require.displacement", positive(""), derived, "", bound, largest + "displacement",
       [](Scene& s) { return &s.require.displacement; }},
      {"require.velocity", positive(""), derived, "", bound, largest + "velocity",
       [](Scene& s) { return &s.require.velocity; }},
      {"require.stress", positive(""), derived, "", bound, largest + "stress",
       [](Scene& s) { return &s.require.stress; }},
  };
}

constexpr std::array optional_tables{
    OptionalTable{"initial.velocity", [](const Scene& scene) { return scene.initial_velocity.has_value(); },
                  [](Scene& scene) { scene.initial_velocity.emplace(); }},
    OptionalTable{"initial.displacement",
                  [](const Scene& scene) { return scene.initial_displacement.has_value(); },
                  [](Scene& scene) { scene.initial_displacement.emplace(); }},
    OptionalTable{"rest", [](const Scene& scene) { return scene.rest.has_value(); },
                  [](Scene& scene) { scene.rest.emplace(); }}};

}  // namespace

const std::vector<KeyRow>& key_table() {
  static const std::vector<KeyRow> table = [] {
    std::vector<KeyRow> rows = make_key_table();
    add_law_parameters(rows);
    return rows;
  }();
  return table;
}

const KeyRow* find_key(const std::string& path) {
  for (const KeyRow& row : key_table()) {
    if (row.path == path) return &row;
  }
  return nullptr;
}

const OptionalTable* find_optional_table(const std::string& path) {
  for (const OptionalTable& table : optional_tables) {
    if (table.path == path) return &table;
  }
  return nullptr;
}

bool is_table(const std::string& path) {
  return std::any_of(key_table().begin(), key_table().end(),
                     [&](const KeyRow& row) { return row.path.starts_with(path + '.'); });
}

std::vector<std::string> names_in(const std::string& path) {
  std::vector<std::string> names;
  const std::string prefix = path.empty() ? "" : path + '.';
  for (const KeyRow& row : key_table()) {
    if (!row.path.starts_with(prefix)) continue;
    const std::string rest = row.path.substr(prefix.size());
    const std::string name = rest.substr(0, rest.find('.'));
    if (names.empty() || names.back() != name) names.push_back(name);
  }
  if (path.empty()) names.insert(names.end(), {"effect", "probe"});
  return names;
}

}  // namespace detail

namespace {

SceneKey key_of(const std::string& path, const detail::ValueRule& rule) {
  return {.path = path,
          .type = detail::type_name(rule.type),
          .unit = rule.unit,
          .range = detail::range_text(rule),
          .words = rule.words};
}

}  // namespace

const std::vector<SceneKey>& scene_keys() {
  static const std::vector<SceneKey> keys = [] {
    std::vector<SceneKey> all;
    for (const detail::KeyRow& row : detail::key_table()) {
      SceneKey key = key_of(row.path, row.rule);
      key.condition = row.condition;
      if (const auto* table = detail::find_optional_table(detail::parent_path(row.path)))
        key.optional_table = table->path;
      key.required = row.absent == detail::Absent::missing;
      key.standard = row.standard;
      key.meaning = row.meaning;
      all.push_back(std::move(key));
    }
    return all;
  }();
  return keys;
}

std::vector<SceneKey> parameter_keys(const EffectType& effect) {
  std::vector<SceneKey> keys;
  for (const EffectParameter& parameter : effect.parameters) {
    SceneKey key = key_of(parameter.name, detail::rule_of(parameter));
    key.required = !parameter.default_value.has_value();
    if (parameter.default_value) key.standard = detail::toml_value(*parameter.default_value);
    key.meaning = parameter.meaning;
    keys.push_back(std::move(key));
  }
  return keys;
}

}  // namespace hompm

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
