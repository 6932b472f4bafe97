// Defaults that follow from other keys, and what keys demand of each other.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <hompm/kit/scene_file/keys.hpp>
#include <hompm/kit/scene_file/reading.hpp>
#include <hompm/materials/material.hpp>
#include <hompm/numerics/elementary.hpp>
#include <hompm/scene/scene.hpp>
#include <hompm/scheme/scheme.hpp>

namespace hompm::detail {
namespace {

void complete_name(Reading& reading) {
  if (reading.silent_on("case"))
    reading.scene.case_name = std::filesystem::path(reading.said.source).stem().string();
  const auto no_part_of_a_path = [](char c) {
    return c == '/' || std::iscntrl(static_cast<unsigned char>(c));
  };
  for (const auto& [key, name] :
       {std::pair{"case", &reading.scene.case_name}, {"variant", &reading.scene.variant}})
    if (reading.has(key) && std::ranges::any_of(*name, no_part_of_a_path))
      reading.report(reading.said.where(key),
                     '`' + std::string(key) +
                         "` is part of the name of the output folder: it must not hold \"/\" or control "
                         "characters, as \"" +
                         printable(*name) + "\" does");
}

void complete_kinematics(Reading& reading) {
  Scene& scene = reading.scene;
  if (!reading.has("material.law")) return;
  const bool small_strain = find_law(scene.material.law).small_strain;
  const Kinematics demanded = small_strain ? Kinematics::infinitesimal : Kinematics::finite;
  if (reading.silent_on("kinematics")) scene.kinematics = demanded;
  if (!reading.has("kinematics") || scene.kinematics == demanded) return;
  reading.report(reading.said.where("kinematics"),
                 small_strain
                     ? "the law " + scene.material.law +
                           (scene.material.law == "linear" ? ", σ = E (λ − 1)," : "") +
                           " holds for small strain only: it needs kinematics = \"infinitesimal\", not "
                           "\"finite\""
                     : "the law " + scene.material.law +
                           " follows the change of volume: it needs kinematics = \"finite\", not "
                           "\"infinitesimal\"; the small-strain law is linear");
}

/// Every parameter of the law, and none of another.
void check_law(Reading& reading) {
  if (!reading.has("material.law")) return;
  const MaterialLaw& law = find_law(reading.scene.material.law);
  bool complete = reading.has("material.youngs_modulus");
  for (const MaterialLaw& other : material_laws())
    for (const LawParameter& parameter : other.parameters) {
      const std::string key = "material." + parameter.name;
      const bool own = other.name == law.name;
      complete = complete && (!own || reading.has(key));
      if (own && reading.silent_on(key) && !reading.meant.contains(key))
        reading.report(reading.said.where("material.law"), '`' + key + "` is missing; the law " + law.name +
                                                               " needs " + demand(find_key(key)->rule));
      if (!own && !reading.silent_on(key) &&
          std::ranges::find(law.parameters, parameter.name, &LawParameter::name) == law.parameters.end())
        reading.report(reading.said.where(key),
                       '`' + key + "` goes with the law " + other.name + ", not " + law.name);
    }
  if (!complete || law.conflict == nullptr) return;
  if (const std::string reason = law.conflict(reading.scene); !reason.empty())
    reading.report(reading.said.where("material.law"),
                   "the law " + law.name + " does not go with this scene: " + reason);
}

/// What is computed from the time of a wave, critical step and relaxation, must not overflow.
void check_wave_time(Reading& reading) {
  if (!reading.has("material.density") || !reading.has("material.youngs_modulus") ||
      !reading.has("body.length"))
    return;
  const MaterialSpec& material = reading.scene.material;
  const double time = reading.scene.body.length / std::sqrt(material.youngs_modulus / material.density);
  if (time >= 1e-200 && time <= 1e200) return;
  reading.report(reading.said.where("material.youngs_modulus"),
                 "the time of a wave through the body, length/√(youngs_modulus/density), must be from 1e-200 "
                 "to 1e200 s, not " +
                     toml_number(time));
}

void check_degree(Reading& reading, const Scheme& scheme) {
  int& degree = reading.scene.scheme.degree;
  if (degree >= scheme.lowest_degree && degree <= scheme.highest_degree) return;
  if (reading.has("scheme.degree")) {
    const std::string possible =
        scheme.lowest_degree == scheme.highest_degree
            ? std::to_string(scheme.lowest_degree) + ", the only degree of the scheme "
            : demand({.type = ValueType::integer,
                      .minimum = static_cast<double>(scheme.lowest_degree),
                      .maximum = static_cast<double>(scheme.highest_degree)}) +
                  " with the scheme ";
    reading.report(reading.said.where("scheme.degree"),
                   "`scheme.degree` must be " + possible + scheme.name + ", not " +
                       shown(reading.said.find("scheme.degree")->content));
  }
  degree = scheme.lowest_degree;  // so that what follows is wrong for any degree
}

void check_margin(Reading& reading) {
  const SchemeSpec& scheme = reading.scene.scheme;
  if (!reading.has("scheme.margin_cells") || scheme.margin_cells >= scheme.degree + 1) return;
  reading.report(reading.said.where("scheme.margin_cells"),
                 "`scheme.margin_cells` must be a whole number of at least " +
                     std::to_string(scheme.degree + 1) + ", the degree + 1, not " +
                     shown(reading.said.find("scheme.margin_cells")->content));
}

void complete_scheme(Reading& reading, const Scheme& scheme) {
  const bool degree_is_said = !reading.silent_on("scheme.degree");
  if (degree_is_said) check_degree(reading, scheme);
  Scene own;
  own.scheme.choices = scheme.choices;
  own.scheme.degree = scheme.default_degree;
  const int degree = degree_is_said ? reading.scene.scheme.degree : scheme.default_degree;
  // A free end that moves by less than a quarter of the body stays on the grid.
  own.scheme.margin_cells = std::max(degree + 2, (reading.scene.scheme.cells + 3) / 4);
  const bool ready =
      reading.has("material.density") && reading.has("material.youngs_modulus") && reading.has("body.length");
  if (scheme.relaxes && ready) {
    // The first angular frequency between fixed ends: the result hardly depends on it.
    const MaterialSpec& material = reading.scene.material;
    own.scheme.relaxation_rate =
        numerics::pi * std::sqrt(material.youngs_modulus / material.density) / reading.scene.body.length;
  }
  for (const KeyRow& row : key_table())
    if (row.absent == Absent::of_scheme && reading.silent_on(row.path)) copy_value(row, own, reading.scene);
  check_margin(reading);
}

/// Reports choices that do not go together, at the one the scene made itself.
void check_choices(Reading& reading) {
  const SchemeChoices& c = reading.scene.scheme.choices;
  const auto demand_that = [&](bool met, const std::string& key, const std::string& message) {
    if (met) return;
    const std::string path = "scheme." + key;
    const auto said = reading.silent_on(path) ? std::string("scheme.name") : path;
    reading.report(reading.said.where(said), '`' + path + "` " + message);
  };
  const bool domains = c.basis != Basis::splines;
  const std::string of_hats = "other than \"splines\" is made of hat functions: `scheme.";
  demand_that(!domains || reading.scene.scheme.degree == 1, "basis",
              of_hats + "degree` must be 1, not " + std::to_string(reading.scene.scheme.degree));
  demand_that(!domains || c.quadrature == Quadrature::particles, "basis",
              of_hats + "quadrature` must be \"particles\"");
  demand_that(!domains || c.velocity_projection == VelocityProjection::lumped, "basis",
              of_hats + "velocity_projection` must be \"lumped\"");
  demand_that(!domains || !c.markers, "basis", of_hats + "markers` must be false: a marker has no domain");
  demand_that(!domains || !(reading.scene.scheme.relaxation_rate > 0.0), "basis",
              of_hats + "relaxation_rate` must be 0");
  demand_that(!domains || reading.scene.scheme.cells >= 3 || !reading.has("scheme.cells"), "cells",
              "must be at least 3 with a basis of hat functions over domains");
  const bool has_fields = reconstructs(c.quadrature);
  const std::string needs_fields =
      "needs reconstructed fields: `scheme.quadrature` must be \"reconstructed\", \"reconstructed-exact\", "
      "\"moving-least-squares\" or \"taylor-least-squares\"";
  demand_that(has_fields || c.acceleration_mass == MassForm::lumped, "acceleration_mass",
              "= \"consistent\" " + needs_fields);
  demand_that(has_fields || c.velocity_projection != VelocityProjection::consistent, "velocity_projection",
              "= \"consistent\" " + needs_fields);
  const bool lumped_velocity = c.velocity_projection == VelocityProjection::lumped;
  demand_that(
      !has_fields || !lumped_velocity || c.acceleration_mass == MassForm::lumped ||
          c.conserve == Conserve::momentum,
      "velocity_projection",
      "= \"lumped\" divides momenta of particles by their masses, not by row sums of a consistent mass: "
      "`scheme.acceleration_mass` must be \"lumped\", or `scheme.conserve` \"momentum\"");
  demand_that(
      !lumped_velocity || !c.markers, "velocity_projection",
      "= \"lumped\" leaves functions that a marker alone touches without a velocity: `scheme.markers` "
      "must be false");
  demand_that(has_fields || c.free_end == FreeEnd::particles, "free_end",
              "other than \"particles\" " + needs_fields);
  demand_that(has_fields || c.conserve != Conserve::cell_mass, "conserve", "= \"cell-mass\" " + needs_fields);
  demand_that(
      c.conserve != Conserve::cell_momentum || c.velocity_projection == VelocityProjection::consistent,
      "conserve",
      "= \"cell-momentum\" shifts what is projected with the consistent mass: "
      "`scheme.velocity_projection` must be \"consistent\"");
  const bool parabolas =
      c.quadrature == Quadrature::moving_least_squares || c.quadrature == Quadrature::taylor_least_squares;
  demand_that(!parabolas || reading.scene.scheme.degree <= highest_degree_of_parabolas, "quadrature",
              "by least squares makes parabolas: `scheme.degree` must be at most " +
                  std::to_string(highest_degree_of_parabolas) + ", not " +
                  std::to_string(reading.scene.scheme.degree));
  demand_that(
      c.quadrature != Quadrature::mixed || reading.scene.scheme.degree == 1, "quadrature",
      "= \"mixed\" needs `scheme.degree` = 1: one stress a cell leaves motions of higher degree without "
      "stiffness");
  demand_that(c.position_update == PositionUpdate::after_projection || c.sequence == Sequence::musl,
              "position_update", "= \"before-projection\" is of `scheme.sequence` \"musl\"");
  demand_that(c.conserve != Conserve::momentum || c.acceleration_mass == MassForm::consistent, "conserve",
              "= \"momentum\" corrects the consistent mass: `scheme.acceleration_mass` must be "
              "\"consistent\"; lumped mass conserves momentum as it is");
  demand_that(
      c.free_end != FreeEnd::extension || c.acceleration_mass == MassForm::consistent || !lumped_velocity,
      "free_end",
      "= \"extension\" ties functions of a consistent mass: `scheme.acceleration_mass` or "
      "`scheme.velocity_projection` must have one");
  demand_that(c.transfer != Transfer::apic || c.sequence == Sequence::usl, "transfer",
              "= \"apic\" gives back the velocity after the kick: `scheme.sequence` must be \"usl\"");
  demand_that(c.transfer != Transfer::apic || c.velocity_projection == VelocityProjection::lumped, "transfer",
              "= \"apic\" is a projection of its own: `scheme.velocity_projection` must be \"lumped\"");
  demand_that(c.transfer == Transfer::flip || c.flip_fraction == 1.0, "flip_fraction",
              "mixes FLIP and PIC: `scheme.transfer` must be \"flip\"");
  demand_that(c.sequence != Sequence::usf || c.time_integrator == TimeIntegrator::euler_cromer, "sequence",
              "= \"usf\" strains before the forces: `scheme.time_integrator` must be \"euler-cromer\"");
  demand_that(c.sequence != Sequence::usf || c.stress_update != StressUpdate::from_positions, "sequence",
              "= \"usf\" strains before it moves: `scheme.stress_update` must be \"incremental\" or "
              "\"from-stretch\"");
  demand_that(
      !(reading.scene.scheme.relaxation_rate > 0.0) || c.stress_update == StressUpdate::from_positions,
      "relaxation_rate",
      "moves particles: `scheme.stress_update` must be \"from-positions\", so that the stress follows; "
      "high-order has it");
}

void check_particle_count(Reading& reading) {
  const std::int64_t particles =
      std::int64_t{reading.scene.scheme.cells} * std::int64_t{reading.scene.scheme.particles_per_cell};
  if (particles <= most_particles) return;
  reading.report(reading.said.where("scheme.cells"),
                 "`scheme.cells` times `scheme.particles_per_cell` must be at most " +
                     std::to_string(most_particles) + " particles, not " + std::to_string(particles));
}

void check_time_step(Reading& reading) {
  std::vector<std::string> said;
  for (const std::string name : {"time_step", "courant", "step_fraction"}) {
    const std::string path = "scheme." + name;
    if (!reading.silent_on(path)) said.push_back(path);
    if (reading.meant.contains(path)) return;
  }
  if (said.empty() && !reading.meant.contains("scheme"))
    reading.report(reading.said.where("scheme"),
                   "the time step is missing: give one of `scheme.time_step` (s), `scheme.courant`, "
                   "`scheme.step_fraction`");
  const auto position = [&](const std::string& path) {
    const Origin& key = reading.said.find(path)->key;
    return std::tuple(key.line, key.column);
  };
  std::stable_sort(said.begin(), said.end(),
                   [&](const std::string& a, const std::string& b) { return position(a) < position(b); });
  for (std::size_t index = 1; index < said.size(); ++index)
    reading.report(reading.said.find(said[index])->key,
                   '`' + said[index] + "` and `" + said[0] + "` exclude each other: give one");
}

}  // namespace

void complete(Reading& reading) {
  complete_name(reading);
  complete_kinematics(reading);
  const auto& schemes = scheme_table();
  const auto scheme = std::find_if(schemes.begin(), schemes.end(),
                                   [&](const Scheme& row) { return row.name == reading.scene.scheme.name; });
  if (scheme != schemes.end()) {
    complete_scheme(reading, *scheme);
    check_choices(reading);
  } else {
    reading.scene.scheme.degree = 1;  // no scheme says what it may be
  }
  check_law(reading);
  check_wave_time(reading);
  check_body(reading);
  check_particle_count(reading);
  check_time_step(reading);
}

}  // namespace hompm::detail
