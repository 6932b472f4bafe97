#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <hompm/number.hpp>
#include <hompm/simulation/columns.hpp>
#include <hompm/verify/foreign_comparison.hpp>
#include <hompm/verify/foreign_golden.hpp>
#include <hompm/verify/foreign_matching.hpp>
#include <hompm/verify/foreign_truth.hpp>

namespace hompm {
namespace {

namespace fs = std::filesystem;
using detail::ParticleBlock;
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

const std::vector<double>* exact_values(const std::optional<ReferenceFields>& exact,
                                        const std::string& field) {
  if (!exact) return nullptr;
  if (field == "displacement") return &exact->displacement;
  if (field == "velocity") return &exact->velocity;
  return field == "stress" ? &exact->stress : nullptr;
}

bool within(const Tolerance& tolerance, double scale, double a, double b) {
  const double distance = std::abs(a - b);
  return (tolerance.absolute > 0.0 && distance <= tolerance.absolute) ||
         (tolerance.relative > 0.0 && distance <= tolerance.relative * scale) ||
         (tolerance.ulps > 0 && ulp_distance(a, b) <= tolerance.ulps);
}

/// The figures of `curves`, of which `pairs` belong together. Adds the differences to `curves`.
ForeignField compare_field(const ForeignOptions& options, ForeignCurves& curves, const Pairs& pairs,
                           double scale) {
  const auto tolerance = options.tolerances.find(curves.field);
  const bool has_tolerance = tolerance != options.tolerances.end();
  const bool any_bound = !options.tolerances.empty() || !options.exact.empty();
  ForeignField result;
  result.field = curves.field;
  result.time = curves.time;
  result.scale = scale;
  result.particles = pairs.size();
  std::vector<double> a;
  std::vector<double> b;
  double worst = 0.0;
  for (const auto& [i, j] : pairs) {
    a.push_back(curves.a[i]);
    b.push_back(curves.b[j]);
    const double difference = a.back() - b.back();
    curves.X_matched.push_back(curves.X_b[j]);
    curves.difference.push_back(difference);
    if (std::isnan(difference)) continue;  // there is a message already
    if (ulp_distance(a.back(), b.back()) == 0) continue;
    if (result.differing++ == 0 || std::abs(difference) > worst) {
      worst = std::abs(difference);
      result.worst_X = curves.X_b[j];
    }
    const bool excused = has_tolerance ? within(tolerance->second, scale, a.back(), b.back()) : any_bound;
    if (!excused) ++result.beyond;
  }
  result.difference = error_norms(a, b);
  if (!curves.exact_a.empty()) result.error = error_norms(curves.a, curves.exact_a);
  if (!curves.exact_b.empty()) result.golden_error = error_norms(curves.b, curves.exact_b);
  if (const auto bound = options.exact.find(curves.field); bound != options.exact.end() && result.error) {
    result.beyond_exact = !(result.error->max <= bound->second * scale);  // NaN is beyond
  }
  return result;
}

/// The blocks of A for the matches, in their order.
std::vector<ParticleBlock> read_matches(detail::ForeignTable& table,
                                        const std::vector<detail::TimeMatch>& matches) {
  std::vector<double> times;
  for (const auto& match : matches) times.insert(times.end(), match.sources.begin(), match.sources.end());
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  const auto blocks = table.read(times);
  std::vector<ParticleBlock> result;
  for (const auto& match : matches) {
    std::vector<ParticleBlock> sources;
    for (const double time : match.sources) {
      sources.push_back(*std::ranges::find(blocks, time, &ParticleBlock::time));
    }
    result.push_back(detail::block_at(table, match, sources));
  }
  return result;
}

/// The comparison with all that was said, and its verdict.
ForeignComparison judged(ForeignComparison result, const detail::MessageLog& faults,
                         const detail::MessageLog& notes) {
  result.messages = faults.messages();
  result.notes = notes.messages();
  const auto any = [&](auto test) { return std::ranges::any_of(result.fields, test); };
  if (!result.messages.empty() || any([](const auto& f) { return f.beyond > 0 || f.beyond_exact; })) {
    result.verdict = Verdict::different;
  } else if (any([](const auto& f) { return f.differing > 0; })) {
    result.verdict = Verdict::equivalent;
  }
  return result;
}

}  // namespace

const std::vector<std::string>& foreign_fields() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names;
    for (const auto& column : std::span(detail::all_columns).last<7>()) names.emplace_back(column.name);
    return names;
  }();
  return all;
}

const std::vector<std::string>& exact_fields() {
  static const std::vector<std::string> all{"displacement", "velocity", "stress"};
  return all;
}

ForeignComparison compare_foreign(const fs::path& a, const fs::path& b, const ForeignOptions& options) {
  ForeignComparison result;
  detail::MessageLog faults;
  detail::MessageLog notes;

  // 1. What there is on both sides.
  detail::ParticleFields golden = detail::read_golden(b, faults, notes);
  if (golden.blocks.empty()) return judged(std::move(result), faults, notes);
  detail::ForeignTruth truth(b, notes);
  if (!options.exact.empty() && !truth.is_known()) {
    throw OptionError("--exact: no exact solution of the scene of " + b.string() + " is known");
  }
  std::vector<double> times;
  for (const std::size_t t : detail::wanted_blocks(golden, options.times)) {
    times.push_back(golden.blocks[t].time);
  }
  const auto only_time = options.times.empty() || times.size() > 1 ? std::nullopt : std::optional(times[0]);
  detail::ForeignTable table(a, foreign_fields(), only_time, faults, notes);
  if (!table.is_usable()) return judged(std::move(result), faults, notes);

  // 2. Which times belong together, and what A has there.
  const double last = golden.blocks.back().time;
  const bool at_rest = truth.is_at_rest(last);
  std::vector<detail::TimeMatch> matches;
  if (truth.ends_at_rest()) {
    matches.push_back({last, {table.times().back()}});
    table.note("the scene ends at rest: A is taken to be at rest at its last time, " +
               to_text(table.times().back()) + ", and held against B at " + to_text(last) +
               (at_rest ? "" : ", which is not at rest"));
  } else {
    matches = detail::match_times(table, times, last, options.interpolate);
  }
  detail::ParticleFields mine{table.fields(), read_matches(table, matches)};
  if (!mine.has("displacement")) {
    mine.derive_displacement();
    golden.derive_displacement();
  }
  for (const auto& field : options.required) {
    if (mine.has(field)) continue;
    table.fault("missing columns", "a bound is asked for `" + field + "`, but there is no such column");
  }

  // 3. Field by field, in the order of times: references only go forward.
  for (std::size_t t = 0; t < matches.size(); ++t) {
    const auto same_time = std::ranges::find(golden.blocks, matches[t].time, &ParticleBlock::time);
    const auto t_b = static_cast<std::size_t>(same_time - golden.blocks.begin());
    const Pairs pairs = detail::match_particles(table, mine.blocks[t], *same_time);
    const auto exact_a = truth.at("A", mine.blocks[t]);
    const auto exact_b = truth.ends_at_rest() && !at_rest ? std::nullopt : truth.at("B", *same_time);
    for (const auto& field : foreign_fields()) {
      if (!mine.has(field) || !golden.has(field)) continue;
      ForeignCurves curves;
      curves.field = field;
      curves.time = matches[t].time;
      curves.X_a = mine.blocks[t].X;
      curves.a = mine.values(field, t);
      curves.X_b = same_time->X;
      curves.b = golden.values(field, t_b);
      if (const auto* values = exact_values(exact_a, field)) curves.exact_a = *values;
      if (const auto* values = exact_values(exact_b, field)) curves.exact_b = *values;
      result.fields.push_back(compare_field(options, curves, pairs, golden.largest(field)));
      if (options.exact.count(field) > 0 && !result.fields.back().error) {
        table.fault("missing exact solutions",
                    "the exact " + field + " at time " + to_text(curves.time) + " is not known");
      }
      result.curves.push_back(std::move(curves));
    }
  }
  result.reference = truth.description();
  result.reference_error = truth.own_error();
  const auto place = [](const auto& item) { return std::ranges::find(foreign_fields(), item.field); };
  std::ranges::stable_sort(result.fields, {}, place);
  std::ranges::stable_sort(result.curves, {}, place);
  return judged(std::move(result), faults, notes);
}

}  // namespace hompm
