#include "listing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <nlohmann/json.hpp>

#include <hompm/kit/recorder/checkpoint.hpp>
#include <hompm/kit/recorder/trace_file.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/number.hpp>
#include <hompm/simulation/critical_step.hpp>

#include "common.hpp"

namespace hompm {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SchemeLook, colour, dash, shape)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Scheme, name, summary, source, lowest_degree, highest_degree,
                                   default_degree, look)

namespace cli {
namespace {

using Json = nlohmann::ordered_json;

/// A member that is a text.
const std::string& text_in(const Json& object, const char* member) {
  return object[member].get_ref<const std::string&>();
}

std::string joined(const Json& words) {
  std::string text;
  for (const Json& word : words) text += (text.empty() ? "" : ", ") + word.get<std::string>();
  return text.empty() ? "none" : text;
}

// --keys and --list

Json json(const SceneKey& key) {
  return {{"path", key.path},         {"type", key.type},
          {"unit", key.unit},         {"range", key.range},
          {"words", key.words},       {"condition", key.condition},
          {"required", key.required}, {"optional_table", key.optional_table},
          {"default", key.standard},  {"meaning", key.meaning}};
}

Json all_effects() {
  Json effects = Json::array();
  for (const EffectType& effect : effect_catalogue()) {
    Json parameters = Json::array();
    for (const SceneKey& key : parameter_keys(effect)) parameters.push_back(json(key));
    effects.push_back({{"name", effect.name}, {"meaning", effect.meaning}, {"parameters", parameters}});
  }
  return effects;
}

std::string values(const SceneKey& key) {
  std::string text = key.type == "integer" ? "whole number" : key.type;
  if (key.type == "word" || key.type == "boolean")
    text = key.range;
  else if (!key.range.empty())
    text += ", " + key.range;
  return key.condition.empty() ? text : text + " (" + key.condition + ")";
}

std::string standard(const SceneKey& key) {
  if (key.required)
    return "; must be given" + (key.optional_table.empty() ? "" : " where [" + key.optional_table + "] is");
  return key.standard.empty() ? "" : "; default: " + key.standard;
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return name + (unit.empty() ? "" : " [" + unit + "]");
}

std::string key_text(const SceneKey& key, std::size_t indent) {
  return wrapped("", indent, with_unit(key.path, key.unit) + ": " + values(key) + standard(key)) +
         wrapped("", indent + 4, key.meaning);
}

std::string degrees(const Scheme& scheme) {
  const std::string lowest = "degree " + std::to_string(scheme.lowest_degree);
  return scheme.lowest_degree == scheme.highest_degree
             ? lowest
             : lowest + " to " + std::to_string(scheme.highest_degree) + ", default " +
                   std::to_string(scheme.default_degree);
}

Json catalogue_json() {
  Json all{{"formats", {{"checkpoint", checkpoint_format}, {"trace", detail::trace_format}}}};
  for (const auto& scene : builtin_scenes())
    all["cases"].push_back(
        {{"case", scene.case_name}, {"variant", scene.variant}, {"default", scene.is_default}});
  all["schemes"] = nlohmann::json(scheme_table());
  for (const MaterialLaw& law : material_laws())
    all["materials"].push_back({{"name", law.name}, {"formula", law.formula}});
  all["effects"] = all_effects();
  return all;
}

// --explain

Json effects_left_out(const Scene& scene) {
  Json names = Json::array();
  for (const auto& type : effects_of(scene)) {
    const auto is_present = [&](const EffectSpec& spec) { return spec.type == type.name; };
    if (std::none_of(scene.effects.begin(), scene.effects.end(), is_present)) names.push_back(type.name);
  }
  return names;
}

Json names_of(const State& state, const Fields& fields) {
  Json names = Json::array();
  for (const Field field : fields) names.push_back(info_of(state, field).name);
  return names;
}

Json stages_of(const Plan& plan, const State& state) {
  Json stages = Json::array();
  for (const auto& phase : plan.phases)
    for (const Stage& stage : phase)
      stages.push_back({{"phase", title_of(stage.phase)},
                        {"name", stage.name},
                        {"for", stage.called_by},
                        {"reads", names_of(state, stage.reads)},
                        {"changes", names_of(state, stage.changes)},
                        {"writes", names_of(state, stage.writes)}});
  return stages;
}

/// What the scene has beyond the fields of every state.
Json fields_of(const State& state) {
  Json fields = Json::array();
  for (const DeclaredField& field : state.declared)
    fields.push_back({{"name", field.name},
                      {"unit", field.unit},
                      {"meaning", field.meaning},
                      {"persists", field.persists},
                      {"reported", field.reported}});
  return fields;
}

Json couplings_of(const Simulation& simulation) {
  Json couplings = Json::array();
  for (const Coupling& coupling : simulation.couplings())
    couplings.push_back({{"phase", title_of(coupling.phase)},
                         {"name", coupling.name},
                         {"for", coupling.called_by},
                         {"bodies", {coupling.left, coupling.left + 1}},
                         {"changes", names_of(simulation.state(coupling.left), coupling.changes[0])}});
  return couplings;
}

/// "reads a, b; changes c", as far as there is something.
std::string uses_text(const Json& stage) {
  std::string text;
  for (const char* const verb : {"reads", "changes", "writes"})
    if (stage.contains(verb) && !stage[verb].empty())
      text += (text.empty() ? "" : "; ") + std::string(verb) + " " + joined(stage[verb]);
  return wrapped("", 8, text);
}

/// "scheme tielen2017 (my.toml:3:1)" is said in short where it calls, and in full once.
std::string caller(const Json& stage, std::vector<std::string>& callers) {
  const std::string& full = text_in(stage, "for");
  if (std::ranges::find(callers, full) == callers.end()) callers.push_back(full);
  return full.substr(0, full.find(" ("));
}

std::string explanation_text(const Json& all) {
  std::string text = std::to_string(all["steps"].get<std::int64_t>()) + " steps of " +
                     to_text(all["time_step"].get<double>()) + " s; critical step " +
                     to_text(all["critical_time_step"].get<double>()) + " s\n";
  std::vector<std::string> callers;
  const Json& bodies = all["bodies"];
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    if (bodies.size() > 1) text += "body " + std::to_string(body) + "\n";
    std::string phase;
    int number = 0;
    for (const Json& stage : bodies[body]["stages"]) {
      if (phase != text_in(stage, "phase")) {
        phase = text_in(stage, "phase");
        const bool once = phase == "geometry" && !bodies[body]["moves"].get<bool>();
        text += phase + (once ? " (once: nothing moves)\n" : "\n");
      }
      const std::string head = padded("  " + std::to_string(++number) + ".", 6) + text_in(stage, "name");
      text += padded(head, 52) + "for " + caller(stage, callers) + "\n";
      text += uses_text(stage);
    }
    if (!bodies[body]["fields"].empty()) text += "fields of its own\n";
    for (const Json& field : bodies[body]["fields"])
      text += wrapped("  " + with_unit(text_in(field, "name"), text_in(field, "unit")), 36,
                      text_in(field, "meaning") + (field["persists"].get<bool>() ? "" : "; scratch") +
                          (field["reported"].get<bool>() ? "; reported" : ""));
  }
  if (!all["couplings"].empty()) text += "between bodies\n";
  for (const Json& coupling : all["couplings"])
    text += padded("  " + text_in(coupling, "name"), 52) + "for " + caller(coupling, callers) + "\n" +
            wrapped("", 8,
                    "of bodies " + coupling["bodies"][0].dump() + " and " + coupling["bodies"][1].dump() +
                        ", at the end of the phase " + text_in(coupling, "phase")) +
            uses_text(coupling);
  text += "called for by\n";
  for (const std::string& full : callers) text += wrapped("", 2, full);
  return text + wrapped("effects absent:", 2, joined(all["effects_absent"]));
}

// --critical-step

Json limits_of(const Scene& scene) {
  const double wave_speed = std::sqrt(scene.material.youngs_modulus / scene.material.density);
  const double cell = scene.body.length / scene.scheme.cells;
  Json limits = Json::array();
  const auto add = [&](const std::string& where, const Json& beyond, double step) {
    limits.push_back({{"where", where},
                      {"cells_beyond_breakpoint", beyond},
                      {"step", step},
                      {"courant", step * wave_speed / cell}});
  };
  const double refused_above = critical_time_step(scene);
  const State start = Simulation(scene, 1.0).state();
  CriticalStep critical(scene);
  add("at the start", nullptr, critical.at(start));
  if (moving_free_end(scene))
    for (const double cut : {1e-6, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9})
      add("free end " + to_text(cut) + " cells beyond a breakpoint", cut, critical.with_cut(start, cut));
  add("refused above", nullptr, refused_above);
  return {{"scheme", scene.scheme.name},
          {"degree", scene.scheme.degree},
          {"particles_per_cell", scene.scheme.particles_per_cell},
          {"limits", limits}};
}

std::string critical_steps_text(const Json& bodies) {
  std::string text;
  std::array<char, 96> line{};
  for (const Json& body : bodies) {
    const std::string head = text_in(body, "scheme") + ", p = " + body["degree"].dump() + ", " +
                             body["particles_per_cell"].dump() + " particles per cell";
    std::snprintf(line.data(), line.size(), "%-46s %10s %8s\n", head.c_str(), "step, s", "c dt/h");
    text += line.data();
    for (const Json& limit : body["limits"]) {
      std::snprintf(line.data(), line.size(), "  %-44s %10.4g %8.4f\n", text_in(limit, "where").c_str(),
                    limit["step"].get<double>(), limit["courant"].get<double>());
      text += line.data();
    }
  }
  return text;
}

}  // namespace

std::string catalogue(Form form) {
  if (form == Form::json) return catalogue_json().dump(2) + "\n";
  std::string text = "cases (--case, --variant)\n";
  for (const auto& scene : builtin_scenes())
    text += wrapped("  " + scene.case_name, 12, scene.variant + (scene.is_default ? " (default)" : ""));
  text += "\nschemes (--scheme)\n";
  for (const auto& scheme : scheme_table())
    text += wrapped("  " + scheme.name, 20, scheme.summary + "; " + degrees(scheme)) +
            wrapped("", 20, scheme.source);
  text += "\nmaterials (material.law)\n";
  for (const MaterialLaw& law : material_laws()) {
    text += wrapped("  " + law.name, 18, law.formula);
    for (const LawParameter& parameter : law.parameters)
      text += wrapped("    " + with_unit(parameter.name, parameter.unit), 28, parameter.meaning);
  }
  text += "\neffects ([[effect]] type)\n";
  for (const auto& effect : effect_catalogue()) {
    text += wrapped("  " + effect.name, 18, effect.meaning);
    for (const auto& parameter : effect.parameters)
      text += wrapped("    " + with_unit(parameter.name, parameter.unit), 28, parameter.meaning);
  }
  return text;
}

std::string key_reference(Form form) {
  if (form == Form::json) {
    Json all{{"keys", Json::array()}, {"effects", all_effects()}};
    for (const SceneKey& key : scene_keys()) all["keys"].push_back(json(key));
    return all.dump(2) + "\n";
  }
  std::string text;
  for (const SceneKey& key : scene_keys()) text += key_text(key, 0);
  for (const EffectType& effect : effect_catalogue()) {
    text += "\n[[effect]] type = \"" + effect.name + "\"\n" + wrapped("", 4, effect.meaning);
    for (const SceneKey& key : parameter_keys(effect)) text += key_text(key, 2);
  }
  return text;
}

std::string explanation(const Scene& scene, const TimeStepping& stepping, Form form) {
  const Simulation simulation(scene, stepping.time_step);
  Json bodies = Json::array();
  for (std::size_t body = 0; body < simulation.bodies(); ++body)
    bodies.push_back({{"moves", simulation.state(body).basis_moves},
                      {"stages", stages_of(simulation.plan(body), simulation.state(body))},
                      {"fields", fields_of(simulation.state(body))}});
  const Json all{{"steps", stepping.steps},
                 {"time_step", stepping.time_step},
                 {"critical_time_step", stepping.critical_time_step},
                 {"bodies", bodies},
                 {"couplings", couplings_of(simulation)},
                 {"effects_absent", effects_left_out(scene)}};
  return form == Form::json ? all.dump(2) + "\n" : explanation_text(all);
}

std::string critical_steps(const Scene& scene, Form form) {
  Json bodies = Json::array();
  for (const Scene* body : bodies_of(scene)) bodies.push_back(limits_of(*body));
  return form == Form::json ? Json{{"bodies", bodies}}.dump(2) + "\n" : critical_steps_text(bodies);
}

}  // namespace cli
}  // namespace hompm
