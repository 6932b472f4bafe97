#include "foreign_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

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

/// With one digit behind the point.
std::string tenths(double value) {
  std::array<char, 32> digits{};
  return {digits.begin(),
          std::to_chars(digits.begin(), digits.end(), value, std::chars_format::fixed, 1).ptr};
}

/// −log10 of a difference over the largest value; 17 where every bit agrees.
double digits_of(double part) { return part == 0.0 ? 17.0 : std::max(0.0, -std::log10(part)); }

/// The fields in their order, each once.
std::vector<std::string> fields_of(const ForeignComparison& comparison) {
  std::vector<std::string> names;
  for (const auto& f : comparison.fields)
    if (names.empty() || names.back() != f.field) names.push_back(f.field);
  return names;
}

std::string list(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// How far a field agrees, of all its times: digits of the largest value; nothing where nothing is compared.
struct Agreement {
  std::string field;
  double digits = std::numeric_limits<double>::infinity();  ///< infinity where every bit agrees
  const ForeignField* worst = nullptr;
};

std::vector<Agreement> agreements(const ForeignComparison& comparison, bool exact) {
  std::vector<Agreement> all;
  for (const auto& f : comparison.fields) {
    if (exact ? !f.error : f.particles == 0) continue;
    if (f.field == "x" && fields_of(comparison).size() > 1) continue;  // the displacement tells more
    if (all.empty() || all.back().field != f.field) all.push_back({f.field});
    const double distance = exact ? f.error->max : f.difference.max;
    if (distance == 0.0) continue;
    const double digits = std::max(0.0, -std::log10(distance / f.scale));  // −∞ for a scale of 0, 0 for NaN
    if (digits >= all.back().digits && all.back().worst != nullptr) continue;
    all.back().digits = digits;
    all.back().worst = &f;
  }
  return all;
}

/// "displacement agrees to 14.3 digits, velocity to 12.1 (worst at X = 22.6 m, t = 2.5 s)", or "".
std::string agreement_text(const ForeignComparison& comparison, bool exact) {
  std::string text;
  const ForeignField* worst = nullptr;
  double least = std::numeric_limits<double>::infinity();
  std::string unit = " digits";  // said once
  for (const auto& a : agreements(comparison, exact)) {
    text += text.empty() ? a.field + " agrees " + (exact ? "with the exact solution " : "")
                         : ", " + a.field + " ";
    text += a.worst == nullptr ? "in every bit" : "to " + tenths(a.digits) + std::exchange(unit, "");
    if (a.digits >= least) continue;
    least = a.digits;
    worst = a.worst;
  }
  if (worst != nullptr)
    text += " (worst at " + (exact ? "" : "X = " + rounded(worst->worst_X) + " m, ") +
            "t = " + to_text(worst->time) + " s)";
  return text.empty() ? "" : text + "\n";
}

/// "scheme.sequence = usl, scheme.degree = 2"; "as it is".
std::string changes_text(const SchemeVariant& variant) {
  std::string text;
  for (const auto& [key, value] : variant.changes)
    text.append(text.empty() ? "" : ", ").append(key).append(" = ").append(value);
  return text.empty() ? "as it is" : text;
}

}  // namespace

std::string variants_text(const SchemeVariants& variants, const std::string& a, const std::string& b) {
  const SchemeVariant& plain = variants.tried.front();
  std::vector<std::vector<std::string>> rows{{"scene of " + b}};
  const SchemeVariant& shown_first = plain.refused.empty() ? plain : variants.tried.back();
  for (const auto& [field, part] : shown_first.differences) rows.front().push_back(field);
  const auto add = [&](const SchemeVariant& variant) {
    rows.push_back({changes_text(variant)});
    for (const auto& [field, part] : variant.differences) rows.back().push_back(tenths(digits_of(part)));
    rows.back().resize(rows.front().size(), "-");
  };
  constexpr std::size_t shown = 5;
  for (std::size_t i = 1; i < std::min(variants.tried.size(), shown + 1); ++i) add(variants.tried[i]);
  add(plain);
  std::string text = "digits to which " + a + " agrees with variants of the scheme, best first; " +
                     std::to_string(variants.tried.size()) + " were run, " +
                     std::to_string(variants.refused) + " more are not possible\n" + text_table(rows, 1);
  if (!plain.refused.empty()) text += "as it is: " + plain.refused + "\n";
  if (plain.step >= 0)
    text += "A leaves the scene as it is at step " + std::to_string(plain.step) +
            ", t = " + to_text(plain.time) + " s, first of the times of A: " + plain.field +
            " at X = " + rounded(plain.X) + " m\n";
  for (const auto& note : variants.notes) text += "note: " + note + "\n";
  const bool better =
      variants.tried.size() > 1 && variants.tried[1].largest < std::min(0.1, plain.largest / 3.0);
  return text +
         (better ? "best: " + changes_text(variants.tried[1])
                 : "no variant agrees better than the scene as it is") +
         "\n";
}

std::string variants_json(const SchemeVariants& variants, const std::string& a, const std::string& b) {
  auto tried = Json::array();
  for (const auto& v : variants.tried) {
    Json changes = Json::object();
    for (const auto& [key, value] : v.changes) changes[key] = value;
    Json digits = Json::object();
    for (const auto& [field, part] : v.differences) digits[field] = digits_of(part);
    const Json first{{"step", v.step}, {"time", v.time}, {"X", v.X}, {"field", v.field}};
    tried.push_back({{"changes", changes},
                     {"digits", digits},
                     {"refused", v.refused.empty() ? Json() : Json(v.refused)},
                     {"first_difference", v.step < 0 ? Json() : first}});
  }
  const Json object{{"a", a},
                    {"b", b},
                    {"times", variants.times},
                    {"refused", variants.refused},
                    {"tried", tried},
                    {"notes", variants.notes}};
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string foreign_text(const ForeignComparison& comparison) {
  std::string text = to_string(comparison.verdict) + "\n";
  if (!comparison.fields.empty()) text += "compared: " + list(fields_of(comparison));
  if (!comparison.not_compared.empty())
    text += (comparison.fields.empty() ? "not compared: " : "; not compared, not being in A: ") +
            list(comparison.not_compared);
  if (text.back() != '\n') text += "\n";
  for (const auto& message : comparison.messages) text += message + "\n";
  if (!comparison.fields.empty()) {
    text += "errors over the largest value of the field in B\n";
    std::vector<std::vector<std::string>> rows{{"field", "largest", "time", "particles", "differing",
                                                "beyond", "at X", "A-B max", "A-exact rms", "A-exact max",
                                                "B-exact rms", "B-exact max", ""}};
    for (const auto& f : comparison.fields) {
      const bool any = f.particles > 0;
      const bool fails = f.beyond > 0 || f.beyond_exact;
      if (fails) rows.front().back() = "fails";
      rows.push_back({f.field, rounded(f.scale), to_text(f.time), any ? std::to_string(f.particles) : "-",
                      any ? std::to_string(f.differing) : "-", any ? std::to_string(f.beyond) : "-",
                      f.differing > 0 ? rounded(f.worst_X) : "-", any ? over(f.difference.max, f.scale) : "-",
                      over(f.error, &ErrorNorms::rms, f.scale),
                      over(f.error, &ErrorNorms::max, f.scale) + (f.beyond_exact ? "!" : ""),
                      over(f.golden_error, &ErrorNorms::rms, f.scale),
                      over(f.golden_error, &ErrorNorms::max, f.scale), fails ? "<-" : ""});
    }
    text += text_table(rows, 1);
  }
  if (std::ranges::any_of(comparison.fields, &ForeignField::beyond_exact))
    text += "!: further from the exact solution than --exact allows\n";
  if (!comparison.reference.empty()) {
    text +=
        "exact: " + comparison.reference + " (its own error: " + rounded(comparison.reference_error) + ")\n";
  }
  for (const auto& note : comparison.notes) text += "note: " + note + "\n";
  for (const auto& hint : comparison.hints) text += "perhaps: " + hint + "\n";
  const std::string agreement = agreement_text(comparison, false);
  return text + (agreement.empty() ? agreement_text(comparison, true) : agreement);
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
                      {"fails", f.beyond > 0 || f.beyond_exact},
                      {"worst_X", f.differing > 0 ? Json(f.worst_X) : Json()},
                      {"difference", f.particles > 0 ? json(f.difference) : Json()},
                      {"error", json(f.error)},
                      {"golden_error", json(f.golden_error)}});
  }
  Json digits = Json::object();
  for (const auto& found : agreements(comparison, false)) digits[found.field] = number(found.digits);
  const Json object{{"verdict", to_string(comparison.verdict)},
                    {"a", a},
                    {"b", b},
                    {"messages", comparison.messages},
                    {"hints", comparison.hints},
                    {"notes", comparison.notes},
                    {"compared", fields_of(comparison)},
                    {"not_compared", comparison.not_compared},
                    {"digits", digits},
                    {"reference", comparison.reference.empty() ? Json() : Json(comparison.reference)},
                    {"reference_error", number(comparison.reference_error)},
                    {"fields", fields}};
  // File names may be any bytes.
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace hompm::cli
