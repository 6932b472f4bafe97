#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include <nlohmann/json.hpp>

#include <hompm/build_info.hpp>
#include <hompm/kit/output/run_report.hpp>
#include <hompm/number.hpp>
#include <hompm/scene/scene.hpp>

namespace hompm {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const ErrorNorms& norms) {
  return {{"relative_l2", norms.relative_l2}, {"rms", norms.rms}, {"max", norms.max}};
}

/// Of each body at the end.
Json bodies_json(const Scene& scene, const Snapshot& final) {
  Json bodies = Json::array();
  for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
    std::size_t particles = 0;
    double kinetic = 0.0;
    double momentum = 0.0;
    for (std::size_t i = 0; i < final.size(); ++i) {
      if (final.body[i] != static_cast<std::int64_t>(body)) continue;
      const double mass = final.density[i] * final.volume[i];
      ++particles;
      momentum += mass * final.velocity[i];
      kinetic += 0.5 * mass * final.velocity[i] * final.velocity[i];
    }
    bodies.push_back({{"cells", scene.bodies[body].scheme.cells},
                      {"particles", particles},
                      {"momentum", momentum},
                      {"kinetic", kinetic}});
  }
  return bodies;
}

/// How far snapshots, taken after whole steps, are from the times at which they are due, s.
double largest_shift(const Scene& scene, const TimeStepping& stepping) {
  const std::int64_t count = scene.output.snapshots;
  double largest = 0.0;
  for (std::int64_t k = 1; k < count; ++k) {
    const std::int64_t step = (2 * k * stepping.steps + count) / (2 * count);  // as run.cpp takes them
    const double due = scene.end_time * (static_cast<double>(k) / static_cast<double>(count));
    largest = std::max(largest, std::abs(stepping.time(step, scene.end_time) - due));
  }
  return largest;
}

/// For people: three or four digits.
std::string brief(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
  return text;
}

std::string row(const std::string& name, const ErrorNorms& norms, const std::string& unit) {
  return "    " + padded(name, 14) + padded(brief(norms.relative_l2), 14) +
         padded(brief(norms.rms) + " " + unit, 18) + brief(norms.max) + " " + unit + "\n";
}

/// What keeps the body from rest, as far as the run has seen it.
std::string why_no_rest(const Scene& scene, const RunResult& result) {
  const std::string text = "not reached by the end time: ";
  if (result.last_speed <= scene.rest->speed)
    return text + "the particles became slow enough, but not for the time of a wave there and back";
  return text + "a particle moved at " + brief(result.last_speed) + " m/s in the last step, rest.speed is " +
         brief(scene.rest->speed) + " m/s";
}

std::string share(double part, double whole) { return whole > 0.0 ? brief(part / whole) : std::string("0"); }

}  // namespace

std::string run_json(const RunReport& report) {
  const Scene& scene = report.scene;
  const RunResult& result = report.result;
  const BuildInfo& build = build_info();
  Json json{{"case", scene.case_name},
            {"variant", scene.variant},
            {"title", scene.title},
            {"scheme", scene.scheme.name},
            {"degree", scene.scheme.degree},
            {"cells", scene.scheme.cells},
            {"particles_per_cell", scene.scheme.particles_per_cell},
            {"particles", result.final.size()},
            {"time_step", report.stepping.time_step},
            {"critical_time_step", report.stepping.critical_time_step},
            {"largest_step_fraction", result.largest_step_fraction},
            {"steps", result.steps},
            {"end_time", result.end.time},
            {"at_rest", result.at_rest},
            {"snapshot_interval", scene.end_time / scene.output.snapshots},
            {"snapshot_shift", largest_shift(scene, report.stepping)}};
  Json& errors = json["errors"] = Json::object();
  if (report.errors) {
    errors["reference"] = report.errors->reference;
    errors["reference_error"] = report.errors->reference_errors.displacement;
    for (const auto& field : error_fields) errors[field.name] = json_of((*report.errors).*field.norms);
    errors["kind"] = to_string(report.errors->kind);
    for (const auto& field : error_fields) errors["bound"][field.name] = report.errors->bound.*field.error;
    errors["notes"] = report.errors->notes;
  } else {
    errors["reference"] = nullptr;
    errors["kind"] = "none";
    errors["reason"] = report.no_errors_because;
  }
  const RunVerdict& verdict = report.verdict;
  json["verdict"] = {{"level", to_string(verdict.level)}, {"text", verdict.text}, {"cause", nullptr}};
  if (!verdict.cause.text.empty())
    json["verdict"]["cause"] = {
        {"code", verdict.cause.code}, {"text", verdict.cause.text}, {"cure", verdict.cause.cure}};
  Json& warnings = json["warnings"] = Json::array();
  for (const auto& [code, said] : result.warnings) warnings.push_back({{"code", code}, {"text", said}});
  const HistoryRow& end = result.end;
  json["energy"] = {{"kinetic", end.kinetic},
                    {"stored", end.stored},
                    {"gravity", end.gravity},
                    {"dissipated", end.dissipated},
                    {"external_work", end.external_work},
                    {"residual", end.residual},
                    {"largest_residual", result.largest_residual}};
  json["momentum"] = {{"start", result.start.momentum},
                      {"end", end.momentum},
                      {"impulse", end.impulse},
                      {"residual", end.momentum_residual},
                      {"largest_residual", result.largest_momentum_residual}};
  json["mass"] = {{"start", result.start.mass}, {"end", end.mass}};
  if (!result.final.body.empty()) json["bodies"] = bodies_json(scene, result.final);
  json["largest_internal_force_sum"] = result.largest_internal_force_sum;
  json["build"] = {{"version", build.version},   {"commit", build.commit},
                   {"compiler", build.compiler}, {"flags", build.flags},
                   {"type", build.build_type},   {"architecture", build.architecture},
                   {"boost", build.boost}};
  return json.dump(2) + "\n";
}

std::string timing_json(const RunResult& result, double seconds, std::optional<double> reference_seconds) {
  const double particle_steps = static_cast<double>(result.steps) * static_cast<double>(result.final.size());
  Json json{{"seconds", seconds},
            {"nanoseconds_per_particle_and_step", seconds * 1e9 / particle_steps},
            {"reference_seconds", nullptr}};
  if (reference_seconds) json["reference_seconds"] = *reference_seconds;
  return json.dump(2) + "\n";
}

std::string run_summary(const RunReport& report) {
  const Scene& scene = report.scene;
  const RunResult& result = report.result;
  const TimeStepping& stepping = report.stepping;
  const std::string name = scene.variant.empty() ? scene.case_name : scene.case_name + " " + scene.variant;

  std::string text = name + ", " + scene.scheme.name + " of degree " + std::to_string(scene.scheme.degree);
  if (!scene.title.empty()) text += ": " + scene.title;
  text += "\n  grid      ";
  if (!scene.bodies.empty()) text += std::to_string(scene.bodies.size()) + " bodies, ";
  for (const Scene* body : bodies_of(scene)) {
    if (body != &scene && body != scene.bodies.data()) text += " + ";
    text +=
        std::to_string(body->scheme.cells) + " cells x " + std::to_string(body->scheme.particles_per_cell);
  }
  text += " = " + std::to_string(result.final.size()) + " particles\n";
  text += "  time      " + std::to_string(result.steps) + " steps of " + brief(stepping.time_step) +
          " s to t = " + to_text(result.end.time) + " s; " +
          (std::isfinite(stepping.critical_time_step)
               ? "the critical step is " + brief(stepping.critical_time_step) + " s"
               : std::string("no step is critical"));
  if (const double met = result.largest_step_fraction;
      met > 1.0 && stepping.time_step <= stepping.critical_time_step)
    text += ", and the step was " + brief(met) + " of it for a while";
  text += "\n";
  if (scene.rest) text += "  rest      " + (result.at_rest ? "reached" : why_no_rest(scene, result)) + "\n";
  if (report.errors) {
    const ErrorReport& errors = *report.errors;
    text += "  errors    against " + errors.reference;
    if (const double own = errors.reference_errors.displacement; own > 0.0)
      text += " (its own error: " + brief(own) + ")";
    text += "\n    " + padded("", 14) + padded("relative L2", 14) + padded("rms", 18) + "max\n";
    for (const auto& field : error_fields) text += row(field.name, errors.*field.norms, field.unit);
    for (const std::string& note : errors.notes) text += "    " + note + "\n";
  } else {
    text += "  errors    none: " + report.no_errors_because + "\n";
  }
  const HistoryRow& end = result.end;
  text += "  energy    kinetic " + brief(end.kinetic) + ", stored " + brief(end.stored) + ", gravity " +
          brief(end.gravity) + ", dissipated " + brief(end.dissipated) + ", external work " +
          brief(end.external_work) + " J/m^2\n            largest residual " +
          brief(result.largest_residual) + " J/m^2, " +
          share(result.largest_residual, result.largest_energy) + " of the energy at work\n";
  text += "  momentum  largest residual " + brief(result.largest_momentum_residual) + " kg/(m s), " +
          share(result.largest_momentum_residual, result.largest_momentum) +
          " of what was exchanged; sum of internal forces " + brief(result.largest_internal_force_sum) +
          " of their magnitudes\n";
  text +=
      "  mass      " + brief(end.mass) + " kg/m^2, changed by " + brief(end.mass - result.start.mass) + "\n";
  for (const Warning& warning : result.warnings) text += "  warning   " + warning.code + "\n";
  return text;
}

}  // namespace hompm
