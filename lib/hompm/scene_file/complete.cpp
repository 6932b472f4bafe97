// Defaults that follow from other keys, and what keys demand of each other.
#include <algorithm>
#include <filesystem>
#include <tuple>

#include <hompm/scene_file/keys.hpp>
#include <hompm/scene_file/reading.hpp>
#include <hompm/scheme/scheme.hpp>

namespace hompm::detail {
namespace {

void complete_name(Reading& reading) {
  if (reading.silent_on("case"))
    reading.scene.case_name = std::filesystem::path(reading.said.source).stem().string();
}

void complete_kinematics(Reading& reading) {
  Scene& scene = reading.scene;
  if (!reading.has("material.law")) return;
  const bool small_strain = scene.material.law == "linear";
  const Kinematics demanded = small_strain ? Kinematics::infinitesimal : Kinematics::finite;
  if (reading.silent_on("kinematics")) scene.kinematics = demanded;
  if (!reading.has("kinematics") || scene.kinematics == demanded) return;
  reading.report(reading.said.where("kinematics"),
                 small_strain
                     ? "the law linear, σ = E (λ − 1), holds for small strain only: it needs kinematics = "
                       "\"infinitesimal\", not \"finite\""
                     : "the law " + scene.material.law +
                           " follows the change of volume: it needs kinematics = \"finite\", not "
                           "\"infinitesimal\"; the small-strain law is linear");
}

void complete_degree(Reading& reading, const Scheme& scheme) {
  int& degree = reading.scene.scheme.degree;
  if (reading.silent_on("scheme.degree")) degree = scheme.default_degree;
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

void complete_margin(Reading& reading) {
  SchemeSpec& scheme = reading.scene.scheme;
  if (reading.silent_on("scheme.margin_cells")) {
    // A free end that moves by less than a quarter of the body stays on the grid.
    scheme.margin_cells = std::max(scheme.degree + 2, (scheme.cells + 3) / 4);
  } else if (reading.has("scheme.margin_cells") && scheme.margin_cells < scheme.degree + 1) {
    reading.report(reading.said.where("scheme.margin_cells"),
                   "`scheme.margin_cells` must be a whole number of at least " +
                       std::to_string(scheme.degree + 1) + ", the degree + 1, not " +
                       shown(reading.said.find("scheme.margin_cells")->content));
  }
}

void complete_integration(Reading& reading, const Scheme& scheme) {
  SchemeSpec& spec = reading.scene.scheme;
  if (reading.silent_on("scheme.time_integrator"))
    spec.time_integrator = integrator_names().at(static_cast<std::size_t>(scheme.integrator));
  if (reading.has("scheme.relaxation_rate") && !scheme.relaxes)
    reading.report(reading.said.where("scheme.relaxation_rate"),
                   "`scheme.relaxation_rate`: the scheme " + scheme.name +
                       " has no null-space relaxation; high-order has");
}

void check_particle_count(Reading& reading) {
  constexpr std::int64_t most = 100'000'000;
  const std::int64_t particles =
      std::int64_t{reading.scene.scheme.cells} * std::int64_t{reading.scene.scheme.particles_per_cell};
  if (particles <= most) return;
  reading.report(reading.said.where("scheme.cells"),
                 "`scheme.cells` times `scheme.particles_per_cell` must be at most " + std::to_string(most) +
                     " particles, not " + std::to_string(particles));
}

void check_time_step(Reading& reading) {
  std::vector<std::string> said;
  for (const std::string name : {"time_step", "courant", "step_fraction"}) {
    const std::string path = "scheme." + name;
    if (!reading.silent_on(path)) said.push_back(path);
    if (reading.meant.contains(path)) return;
  }
  if (said.empty() && !reading.meant.contains("scheme")) {
    reading.report(reading.said.where("scheme"),
                   "the time step is missing: give one of `scheme.time_step` (s), `scheme.courant`, "
                   "`scheme.step_fraction`");
  }
  const auto position = [&](const std::string& path) {
    const Origin& key = reading.said.find(path)->key;
    return std::tuple(key.line, key.column);
  };
  std::stable_sort(said.begin(), said.end(),
                   [&](const std::string& a, const std::string& b) { return position(a) < position(b); });
  for (std::size_t index = 1; index < said.size(); ++index) {
    reading.report(reading.said.find(said[index])->key,
                   '`' + said[index] + "` and `" + said[0] + "` exclude each other: give one");
  }
}

}  // namespace

void complete(Reading& reading) {
  complete_name(reading);
  complete_kinematics(reading);
  const auto& schemes = scheme_table();
  const auto scheme = std::find_if(schemes.begin(), schemes.end(),
                                   [&](const Scheme& row) { return row.name == reading.scene.scheme.name; });
  if (scheme != schemes.end()) {
    complete_degree(reading, *scheme);
    complete_margin(reading);
    complete_integration(reading, *scheme);
  }
  check_particle_count(reading);
  check_time_step(reading);
}

}  // namespace hompm::detail
