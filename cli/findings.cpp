#include "findings.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <hompm/number.hpp>

#include "common.hpp"

namespace hompm::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string verdict(const TraceComparison& found) { return found.identical ? "identical" : "different"; }

template <class Found>
std::string verdict(const Found& found) {
  return to_string(found.verdict);
}

/// What all findings begin with, as JSON.
template <class Found>
Json head(const Found& found, const std::string& a, const std::string& b) {
  return {{"verdict", verdict(found)}, {"a", a}, {"b", b}, {"messages", found.messages}};
}

std::string dumped(const Json& object) {
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// Lines, each behind `head`.
std::string lines(const char* head, const std::vector<std::string>& texts) {
  std::string all;
  for (const auto& text : texts) all.append(head).append(text).append("\n");
  return all;
}

// --- two folders

Json object_of(const Difference& d) {
  Json object{{"file", d.file}, {"field", d.field}, {"time", d.time}};
  if (d.particle >= 0) object["particle"] = d.particle;
  object.update({{"a", d.a}, {"b", d.b}, {"ulps", d.ulps}});
  return object;
}

/// The fields that differ, or "" when none does.
std::string table(const std::vector<FieldComparison>& fields) {
  std::vector<std::vector<std::string>> rows{
      {"file", "field", "values", "differing", "beyond", "worst |A-B|", "ulps", "time", "particle"}};
  for (const auto& f : fields) {
    if (f.differing == 0) continue;
    rows.push_back({f.file, f.field, std::to_string(f.values), std::to_string(f.differing),
                    std::to_string(f.beyond), to_text(f.largest_absolute), std::to_string(f.worst.ulps),
                    to_text(f.worst.time), f.worst.particle < 0 ? "-" : std::to_string(f.worst.particle)});
  }
  return rows.size() > 1 ? text_table(rows, 2) : "";
}

// --- results of another code

std::string over(double error, double scale) { return scale > 0.0 ? rounded(error / scale) : rounded(error); }

std::string over(const std::optional<ErrorNorms>& norms, double ErrorNorms::*which, double scale) {
  return norms ? over((*norms).*which, scale) : "-";
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json object_of(const std::optional<ErrorNorms>& norms) {
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
std::vector<std::string> fields_of(const ForeignComparison& found) {
  std::vector<std::string> names;
  for (const auto& f : found.fields)
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

std::vector<Agreement> agreements(const ForeignComparison& found, bool exact) {
  std::vector<Agreement> all;
  for (const auto& f : found.fields) {
    if (exact ? !f.error : f.particles == 0) continue;
    if (f.field == "x" && fields_of(found).size() > 1) continue;  // the displacement tells more
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
std::string agreement_text(const ForeignComparison& found, bool exact) {
  std::string text;
  const ForeignField* worst = nullptr;
  double least = std::numeric_limits<double>::infinity();
  std::string unit = " digits";  // said once
  for (const auto& a : agreements(found, exact)) {
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

// --- traces

std::string difference_text(const TraceDifference& d) {
  std::ostringstream out;
  out << "first difference: step " << d.step;
  if (d.part > 1) out << ", part " << d.part << " of it";
  out << ", " << d.stage;
  if (!d.called_by.empty()) out << " (" << d.called_by << ")";
  out << ", " << d.field;
  if (d.body) out << " of body " << *d.body;
  if (d.values) {
    const TraceValues& v = *d.values;
    if (!v.place.empty()) out << ", " << v.place;
    const char* const unit = v.is_integer ? "" : v.distance == 1 ? " ulp" : " ulps";
    out << "\n  A  "
        << "0x" << hex(v.a) << "  " << v.text_a << "\n  B  "
        << "0x" << hex(v.b) << "  " << v.text_b << "\n  " << v.distance << unit << " apart";
    if (v.size > 1) out << "; " << v.differing << " of the " << v.size << " values of the field differ";
  } else {
    out << "\n  its values are not in " << d.missing_in << ": run both scenes again with --trace-values "
        << d.step;
  }
  return out.str() + "\n";
}

Json object_of(const TraceDifference& d) {
  Json json{
      {"step", d.step}, {"part", d.part}, {"stage", d.stage}, {"called_by", d.called_by}, {"field", d.field}};
  if (d.body) json["body"] = *d.body;
  if (d.values)
    json.update({{"place", d.values->place},
                 {"a", "0x" + hex(d.values->a)},
                 {"b", "0x" + hex(d.values->b)},
                 {d.values->is_integer ? "distance" : "ulps", d.values->distance},
                 {"differing", d.values->differing},
                 {"values", d.values->size}});
  return json;
}

/// "scheme.sequence = usl, scheme.degree = 2"; "as it is".
std::string changes_text(const SchemeVariant& variant) {
  std::string text;
  for (const auto& [key, value] : variant.changes)
    text.append(text.empty() ? "" : ", ").append(key).append(" = ").append(value);
  return text.empty() ? "as it is" : text;
}

}  // namespace

std::string text_of(const Comparison& found) {
  std::ostringstream out;
  out << verdict(found) << '\n';
  if (found.first) {
    const auto& d = *found.first;
    out << "first difference: " << d.file << ", " << d.field << ", time " << to_text(d.time);
    if (d.particle >= 0) out << ", particle " << d.particle;
    out << ": " << to_text(d.a) << " in A, " << to_text(d.b) << " in B, " << d.ulps
        << (d.ulps == 1 ? " ulp\n" : " ulps\n");
  }
  out << lines("", found.messages) << table(found.fields) << lines("note: ", found.notes);
  return out.str();
}

std::string text_of(const ForeignComparison& found) {
  std::string text = verdict(found) + "\n";
  if (!found.fields.empty()) text += "compared: " + list(fields_of(found));
  if (!found.not_compared.empty())
    text += (found.fields.empty() ? "not compared: " : "; not compared, not being in A: ") +
            list(found.not_compared);
  if (text.back() != '\n') text += "\n";
  text += lines("", found.messages);
  if (!found.fields.empty()) {
    text += "errors over the largest value of the field in B\n";
    std::vector<std::vector<std::string>> rows{{"field", "largest", "time", "particles", "differing",
                                                "beyond", "at X", "A-B max", "A-exact rms", "A-exact max",
                                                "B-exact rms", "B-exact max", ""}};
    for (const auto& f : found.fields) {
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
  if (std::ranges::any_of(found.fields, &ForeignField::beyond_exact))
    text += "!: further from the exact solution than --exact allows\n";
  if (!found.reference.empty())
    text += "exact: " + found.reference + " (its own error: " + rounded(found.reference_error) + ")\n";
  text += lines("note: ", found.notes) + lines("perhaps: ", found.hints);
  const std::string agreement = agreement_text(found, false);
  return text + (agreement.empty() ? agreement_text(found, true) : agreement);
}

std::string text_of(const TraceComparison& found) {
  std::ostringstream out;
  out << verdict(found) << "\n" << (found.first ? difference_text(*found.first) : "");
  if (found.identical)
    out << "steps " << found.first_step << " to " << found.last_step << ": every field after every stage\n";
  out << lines("", found.messages) << lines("note: ", found.notes);
  return out.str();
}

std::string json_of(const Comparison& found, const std::string& a, const std::string& b) {
  Json fields = Json::array();
  for (const auto& f : found.fields)
    fields.push_back({{"file", f.file},
                      {"field", f.field},
                      {"values", f.values},
                      {"differing", f.differing},
                      {"beyond", f.beyond},
                      {"worst", f.differing > 0 ? object_of(f.worst) : Json()}});
  Json object = head(found, a, b);
  object.update({{"notes", found.notes},
                 {"first", found.first ? object_of(*found.first) : Json()},
                 {"fields", fields}});
  return dumped(object);
}

std::string json_of(const ForeignComparison& found, const std::string& a, const std::string& b) {
  auto fields = Json::array();
  for (const auto& f : found.fields) {
    fields.push_back({{"field", f.field},
                      {"time", f.time},
                      {"largest", f.scale},
                      {"particles", f.particles},
                      {"differing", f.differing},
                      {"beyond", f.beyond},
                      {"beyond_exact", f.beyond_exact},
                      {"fails", f.beyond > 0 || f.beyond_exact},
                      {"worst_X", f.differing > 0 ? Json(f.worst_X) : Json()},
                      {"difference", f.particles > 0 ? object_of(f.difference) : Json()},
                      {"error", object_of(f.error)},
                      {"golden_error", object_of(f.golden_error)}});
  }
  Json digits = Json::object();
  for (const auto& a_field : agreements(found, false)) digits[a_field.field] = number(a_field.digits);
  Json object = head(found, a, b);
  object.update({{"hints", found.hints},
                 {"notes", found.notes},
                 {"compared", fields_of(found)},
                 {"not_compared", found.not_compared},
                 {"digits", digits},
                 {"reference", found.reference.empty() ? Json() : Json(found.reference)},
                 {"reference_error", number(found.reference_error)},
                 {"fields", fields}});
  return dumped(object);
}

std::string json_of(const TraceComparison& found, const std::string& a, const std::string& b) {
  Json object = head(found, a, b);
  object.update({{"notes", found.notes}, {"first", found.first ? object_of(*found.first) : Json()}});
  return dumped(object);
}

std::string text_of(const SchemeVariants& variants, const std::string& a, const std::string& b) {
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
  text += lines("note: ", variants.notes);
  const bool better =
      variants.tried.size() > 1 && variants.tried[1].largest < std::min(0.1, plain.largest / 3.0);
  return text +
         (better ? "best: " + changes_text(variants.tried[1])
                 : "no variant agrees better than the scene as it is") +
         "\n";
}

std::string json_of(const SchemeVariants& variants, const std::string& a, const std::string& b) {
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
  return dumped(object);
}

}  // namespace hompm::cli
