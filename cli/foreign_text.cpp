#include "foreign_text.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include <hompm/number.hpp>

#include "text_table.hpp"

namespace hompm::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string over(double error, double scale) { return scale > 0.0 ? rounded(error / scale) : rounded(error); }

std::string over(const std::optional<ErrorNorms>& norms, double ErrorNorms::*which, double scale) {
  return norms ? over((*norms).*which, scale) : "-";
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json json(const std::optional<ErrorNorms>& norms) {
  if (!norms) return {};
  return {{"rms", number(norms->rms)}, {"max", number(norms->max)}};
}

}  // namespace

std::string foreign_text(const ForeignComparison& comparison) {
  std::string text = to_string(comparison.verdict) + "\n";
  for (const auto& message : comparison.messages) text += message + "\n";
  if (!comparison.fields.empty()) {
    text += "errors over the largest value of the field in B\n";
    std::vector<std::vector<std::string>> rows{{"field", "largest", "time", "particles", "differing",
                                                "beyond", "at X", "A-B max", "A-exact rms", "A-exact max",
                                                "B-exact rms", "B-exact max"}};
    for (const auto& f : comparison.fields) {
      rows.push_back(
          {f.field, rounded(f.scale), to_text(f.time), std::to_string(f.particles),
           std::to_string(f.differing), std::to_string(f.beyond), f.differing > 0 ? rounded(f.worst_X) : "-",
           over(f.difference.max, f.scale), over(f.error, &ErrorNorms::rms, f.scale),
           over(f.error, &ErrorNorms::max, f.scale) + (f.beyond_exact ? "!" : ""),
           over(f.golden_error, &ErrorNorms::rms, f.scale), over(f.golden_error, &ErrorNorms::max, f.scale)});
    }
    text += text_table(rows, 1);
  }
  for (const auto& f : comparison.fields) {
    if (!f.beyond_exact) continue;
    text += "!: further from the exact solution than --exact allows\n";
    break;
  }
  if (!comparison.reference.empty()) {
    text +=
        "exact: " + comparison.reference + " (its own error: " + rounded(comparison.reference_error) + ")\n";
  }
  for (const auto& note : comparison.notes) text += "note: " + note + "\n";
  return text;
}

std::string foreign_json(const ForeignComparison& comparison, const std::string& a, const std::string& b) {
  auto fields = Json::array();
  for (const auto& f : comparison.fields) {
    fields.push_back({{"field", f.field},
                      {"time", f.time},
                      {"largest", f.scale},
                      {"particles", f.particles},
                      {"differing", f.differing},
                      {"beyond", f.beyond},
                      {"beyond_exact", f.beyond_exact},
                      {"worst_X", f.differing > 0 ? Json(f.worst_X) : Json()},
                      {"difference", json(f.difference)},
                      {"error", json(f.error)},
                      {"golden_error", json(f.golden_error)}});
  }
  const Json object{{"verdict", to_string(comparison.verdict)},
                    {"a", a},
                    {"b", b},
                    {"messages", comparison.messages},
                    {"notes", comparison.notes},
                    {"reference", comparison.reference.empty() ? Json() : Json(comparison.reference)},
                    {"reference_error", number(comparison.reference_error)},
                    {"fields", fields}};
  // File names may be any bytes.
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace hompm::cli
