#include "listing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <hompm/effects/registry.hpp>
#include <hompm/materials/material.hpp>
#include <hompm/number.hpp>
#include <hompm/plan/state_fields.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/scheme/scheme.hpp>
#include <hompm/simulation/critical_step.hpp>
#include <hompm/simulation/simulation.hpp>

namespace hompm::cli {
namespace {

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(text.size() + 1, width), ' ');
  return text;
}

std::string degrees(const Scheme& scheme) {
  if (scheme.lowest_degree == scheme.highest_degree) return "degree " + std::to_string(scheme.lowest_degree);
  return "degree " + std::to_string(scheme.lowest_degree) + " to " + std::to_string(scheme.highest_degree) +
         ", default " + std::to_string(scheme.default_degree);
}

std::string effects_left_out(const hompm::Scene& scene) {
  std::string names;
  for (const auto& type : hompm::effects_of(scene)) {
    const auto is_present = [&](const hompm::EffectSpec& spec) { return spec.type == type.name; };
    if (std::none_of(scene.effects.begin(), scene.effects.end(), is_present))
      names += (names.empty() ? "" : ", ") + type.name;
  }
  return names.empty() ? "none" : names;
}

}  // namespace

std::string catalogue_text() {
  std::string text = "cases (--case, --variant)\n";
  for (const auto& scene : hompm::builtin_scenes())
    text += "  " + padded(scene.case_name, 10) + padded(scene.variant, 12) +
            (scene.is_default ? "default\n" : "\n");
  text += "\nschemes (--scheme)\n";
  for (const auto& scheme : hompm::scheme_table())
    text += "  " + padded(scheme.name, 18) + scheme.summary + "; " + degrees(scheme) + "\n" + padded("", 20) +
            scheme.source + "\n";
  text += "\nmaterials (material.law)\n";
  for (const auto& [name, formula] : hompm::material_laws()) text += "  " + padded(name, 14) + formula + "\n";
  text += "\neffects ([[effect]] type)\n";
  for (const auto& type : hompm::effect_catalogue()) {
    text += "  " + padded(type.name, 16) + type.meaning + "\n";
    for (const auto& parameter : type.parameters)
      text += padded("", 18) +
              padded(parameter.name + (parameter.unit.empty() ? "" : " [" + parameter.unit + "]"), 24) +
              parameter.meaning + "\n";
  }
  return text;
}

namespace {

using Phases = std::array<std::pair<Phase, std::string>, static_cast<std::size_t>(Phase::count_)>;

Phases phases_of(bool moves) {
  return {{
      {Phase::geometry, moves ? "geometry" : "geometry (once: nothing moves)"},
      {Phase::end_stress, "stress at the ends"},
      {Phase::internal_force, "internal force"},
      {Phase::external_force, "external force"},
      {Phase::damping_force, "damping force"},
      {Phase::acceleration, "acceleration"},
      {Phase::velocity, "velocity"},
      {Phase::transfer, "transfer"},
      {Phase::constraint, "constraint"},
      {Phase::work, "work"},
      {Phase::motion, "motion"},
  }};
}

std::string stages_text(const hompm::Plan& plan, bool moves) {
  std::string text;
  int number = 0;
  for (const auto& [phase, title] : phases_of(moves)) {
    if (plan[phase].empty()) continue;
    text += title + "\n";
    for (const auto& stage : plan[phase]) {
      text += "  " + padded(std::to_string(++number) + ".", 4) + padded(stage.name, 50) + "for " +
              stage.called_by + "\n";
      if (!stage.arrays.empty()) text += padded("", 8) + "owns, " + stage.arrays + "\n";
    }
  }
  return text;
}

/// The arrays that the stages of a body work on: those of its state that are there.
std::string arrays_text(const hompm::State& state) {
  constexpr std::array<std::pair<hompm::Site, const char*>, 3> kinds{
      {{hompm::Site::particle, "per particle: "},
       {hompm::Site::particle_function, "per particle and function there: "},
       {hompm::Site::function, "per grid function: "}}};
  std::string text = "arrays of the state\n";
  for (const auto& [site, title] : kinds) {
    std::string names;
    hompm::visit_fields(state, [&, wanted = site](std::string_view name, hompm::Site of, const auto&) {
      if (of != wanted) return;
      const bool own = name.starts_with("basis.");  // the others have their title in common
      names += (names.empty() ? "" : ", ") + std::string(own ? name : name.substr(name.find('.') + 1));
    });
    text += "  " + std::string(title) + names + "\n";
  }
  return text;
}

std::string couplings_text(const hompm::Simulation& simulation) {
  std::string text;
  for (const auto& [phase, title] : phases_of(true))
    for (const auto& coupling : simulation.couplings())
      if (coupling.phase == phase)
        text += "  " + padded(coupling.name, 54) + "for " + coupling.called_by + "\n" + padded("", 8) +
                "of bodies " + std::to_string(coupling.left) + " and " + std::to_string(coupling.left + 1) +
                ", at the end of the phase " + title + "\n";
  return text.empty() ? "" : "between bodies\n" + text;
}

}  // namespace

std::string plan_text(const hompm::Scene& scene, const hompm::TimeStepping& stepping) {
  const hompm::Simulation simulation(scene, stepping.time_step);
  std::string text = std::to_string(stepping.steps) + " steps of " + hompm::to_text(stepping.time_step) +
                     " s; critical step " + hompm::to_text(stepping.critical_time_step) + " s\n";
  for (std::size_t body = 0; body < simulation.bodies(); ++body) {
    if (simulation.bodies() > 1) text += "body " + std::to_string(body) + "\n";
    text += stages_text(simulation.plan(body), simulation.state(body).basis_moves);
    text += arrays_text(simulation.state(body));
  }
  return text + couplings_text(simulation) + "effects absent: " + effects_left_out(scene) + "\n";
}

std::string critical_step_text(const hompm::Scene& scene) {
  const double limit = hompm::critical_time_step(scene);
  const double wave_speed = std::sqrt(scene.material.youngs_modulus / scene.material.density);
  const double cell = scene.body.length / scene.scheme.cells;
  std::string text;
  const auto add = [&](const std::string& where, double step) {
    std::array<char, 96> line{};
    std::snprintf(line.data(), line.size(), "  %-44s %10.4g %8.4f\n", where.c_str(), step,
                  step * wave_speed / cell);
    text += line.data();
  };
  text += scene.scheme.name + ", p = " + std::to_string(scene.scheme.degree) + ", " +
          std::to_string(scene.scheme.particles_per_cell) +
          " particles per cell                 step, s   c dt/h\n";
  const hompm::State start = hompm::Simulation(scene, 1.0).state();
  hompm::CriticalStep critical(scene);
  add("at the start", critical.at(start));
  if (moving_free_end(scene))
    for (const double cut : {1e-6, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9})
      add("free end " + to_text(cut) + " cells beyond a breakpoint", critical.with_cut(start, cut));
  add("refused above", limit);
  return text;
}

}  // namespace hompm::cli
