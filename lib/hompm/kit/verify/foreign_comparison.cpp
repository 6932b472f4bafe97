#include <algorithm>
#include <cmath>

#include <hompm/effects/registry.hpp>
#include <hompm/kit/verify/foreign_comparison.hpp>
#include <hompm/kit/verify/foreign_matching.hpp>
#include <hompm/materials/material.hpp>
#include <hompm/number.hpp>
#include <hompm/scene/scene.hpp>

namespace hompm {
namespace {

namespace fs = std::filesystem;
using detail::ParticleBlock;
using detail::ParticleFields;
using detail::ParticleTable;

std::vector<double> exact_values(const std::optional<ReferenceFields>& exact, const std::string& field) {
  if (!exact) return {};
  if (field == "displacement") return exact->displacement;
  if (field == "velocity") return exact->velocity;
  return field == "stress" ? exact->stress : std::vector<double>();
}

bool within(const Tolerance& tolerance, double scale, double a, double b) {
  const double distance = std::abs(a - b);
  return (tolerance.absolute > 0.0 && distance <= tolerance.absolute) ||
         (tolerance.relative > 0.0 && distance <= tolerance.relative * scale) ||
         (tolerance.ulps > 0 && ulp_distance(a, b) <= tolerance.ulps);
}

/// The figures of `curves`. Adds the differences to `curves`.
ForeignField compare_field(const ForeignOptions& options, ForeignCurves& curves, double scale) {
  const auto tolerance = options.tolerances.find(curves.field);
  const bool has_tolerance = tolerance != options.tolerances.end();
  const bool any_bound = !options.tolerances.empty() || !options.exact.empty();
  ForeignField result{
      .field = curves.field, .time = curves.time, .scale = scale, .particles = curves.pairs.size()};
  std::vector<double> a;
  std::vector<double> b;
  double worst = 0.0;
  for (const auto& [i, j] : curves.pairs) {
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
std::vector<ParticleBlock> read_matches(detail::ParticleTable& table,
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

/// Times of B that are asked for, ascending; all when none is. `near` is what counts as the same.
std::vector<double> wanted_times(const std::vector<double>& all, const std::vector<double>& asked,
                                 double near) {
  if (asked.empty()) return all;
  std::vector<double> wanted;
  std::string known;
  for (const double time : all) known += (known.empty() ? "" : ", ") + to_text(time);
  for (const double time : asked) {
    const auto found = std::ranges::find_if(all, [&](double t) { return std::abs(t - time) <= near; });
    if (found == all.end()) throw OptionError("--time " + to_text(time) + ": B has only the times " + known);
    wanted.push_back(*found);
  }
  std::ranges::sort(wanted);
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  return wanted;
}

/// The times of A at which the exact solution of a scene is asked for: twenty at most, the last among them.
std::vector<double> judged_times(const std::vector<double>& all, const ForeignOptions& options,
                                 const Scene& scene, double near) {
  constexpr std::size_t most = 20;
  std::vector<double> possible;
  for (const double time : all)
    if (time >= 0.0 && time <= scene.end_time + near) possible.push_back(std::min(time, scene.end_time));
  if (possible.size() <= most || !options.times.empty()) return wanted_times(possible, options.times, near);
  std::vector<double> some;
  for (std::size_t i = 1; i <= most; ++i) some.push_back(possible[i * possible.size() / most - 1]);
  return some;
}

/// Whether A has what `field` follows from: the position, mass, or the law of a scene whose stress is that of
/// the law alone.
bool is_told(const ParticleFields& mine, const std::string& field, const std::optional<Scene>& scene) {
  std::vector<std::string> strains{"volume", "density", "stretch"};
  const auto adds_stress = [&](const EffectSpec& spec) { return find_effect(*scene, spec).adds_stress; };
  if (scene && !has_memory(scene->material) && std::ranges::none_of(scene->effects, adds_stress))
    strains.emplace_back("stress");
  for (const auto& group : {std::vector<std::string>{"x", "displacement"}, strains}) {
    if (std::ranges::find(group, field) == group.end()) continue;
    return std::ranges::any_of(group, [&](const auto& other) { return mine.has(other); });
  }
  return mine.has(field);
}

std::string unread(const std::string& column, const std::string& field) {
  return "the column `" + column + "` looks like " + field + " and is not read; --column " + field + "=" +
         column + " reads it, --fields says which fields are wanted";
}

/// What has to be in A and is not, and what is in A and not read.
void check_columns(const ForeignOptions& options, ParticleTable& table, const ParticleFields& mine,
                   const ParticleFields& golden, const std::optional<Scene>& scene,
                   ForeignComparison& result) {
  const auto asked = [&](const std::string& field) {
    return options.fields.empty() || std::ranges::find(options.fields, field) != options.fields.end();
  };
  for (const auto& [column, field] : table.table().lookalikes()) {
    if (asked(field) && std::ranges::find(foreign_fields(), field) != foreign_fields().end())
      table.fault("unread columns", unread(column, field));
  }
  for (const auto& field : foreign_fields()) {
    const bool bounded = options.tolerances.contains(field) || options.exact.contains(field);
    const bool named = std::ranges::find(options.required, field) != options.required.end() ||
                       std::ranges::find(options.fields, field) != options.fields.end();
    if (!asked(field) || mine.has(field)) continue;
    if (golden.has(field)) result.not_compared.push_back(field);
    const bool there = golden.has(field) || options.exact.contains(field);
    if (named || (bounded && there && !is_told(mine, field, scene)))
      table.fault("missing columns", (bounded ? "a bound is asked for `" : "compared shall be `") + field +
                                         "`, but there is no such column" +
                                         (named ? "" : "; --fields says which fields are wanted"));
  }
}

/// The comparison with all that was said, and its verdict.
ForeignComparison judged(ForeignComparison result, const detail::MessageLog& faults,
                         const detail::MessageLog& notes, bool partial) {
  result.messages = faults.messages();
  result.notes = notes.messages();
  const auto any = [&](auto test) { return std::ranges::any_of(result.fields, test); };
  if (result.fields.empty() && result.messages.empty())
    result.messages.emplace_back("nothing could be compared");
  if (!result.messages.empty() || any([](const auto& f) { return f.beyond > 0 || f.beyond_exact; }))
    result.verdict = Verdict::different;
  else if (partial || any([](const auto& f) { return f.differing > 0 || f.particles == 0; }))
    result.verdict = Verdict::equivalent;
  return result;
}

}  // namespace

const std::vector<std::string>& foreign_fields() { return detail::particle_fields(); }

const std::vector<std::string>& exact_fields() {
  static const std::vector<std::string> all{"displacement", "velocity", "stress"};
  return all;
}

ForeignComparison compare_foreign(const fs::path& a, const fs::path& b, const ForeignOptions& options) {
  ForeignComparison result;
  detail::MessageLog faults;
  detail::MessageLog notes;

  // 1. What there is on both sides.
  detail::ForeignTruth truth(b, notes);
  const bool alone = !truth.has_results();  // the exact solution is
  ParticleFields golden = alone ? ParticleFields() : detail::read_golden(b, faults, notes);
  if ((alone || !options.exact.empty()) && !truth.is_known())
    throw OptionError((alone ? "" : "--exact: ") +
                      ("no exact solution of the scene of " + b.string() + " is known"));
  std::vector<double> times;
  for (const auto& block : golden.blocks) times.push_back(block.time);
  const double last = alone ? truth.scene()->end_time : times.back();
  const double near = std::max(1e-9 * (last > 0.0 || !truth.scene() ? last : truth.scene()->end_time),
                               options.time_tolerance);
  if (!alone) times = wanted_times(times, options.times, near);
  detail::TableLayout layout{
      .columns = options.columns, .direction = options.direction, .name = options.name};
  if (options.times.size() == 1) layout.only_time = alone ? options.times[0] : times[0];
  ParticleTable table(a, layout, faults, notes);
  if (alone) times = judged_times(table.times(), options, *truth.scene(), near);

  // 2. Which times belong together, and what A has there.
  const bool at_rest = truth.is_at_rest(last);
  std::vector<detail::TimeMatch> matches;
  if (truth.ends_at_rest() && !alone) {
    matches.push_back({last, {table.times().back()}});
    table.note("the scene ends at rest: A is taken to be at rest at its last time, " +
               to_text(table.times().back()) + ", and held against B at " + to_text(last) +
               (at_rest ? "" : ", which is not at rest"));
  } else {
    matches = detail::match_times(table, times, near, options.interpolate);
  }
  bool partial = matches.size() < times.size() && !truth.ends_at_rest();
  ParticleFields mine{table.fields(), read_matches(table, matches)};
  if (!mine.has("displacement")) {
    mine.derive_displacement();
    golden.derive_displacement();
  }
  check_columns(options, table, mine, golden, truth.scene(), result);

  // 3. The curves in the order of times: references only go forward.
  const bool needs_partners = !options.tolerances.empty() || options.exact.empty();
  const double cell = truth.scene() ? truth.scene()->body.length / truth.scene()->scheme.cells : 0.0;
  for (std::size_t t = 0; t < matches.size(); ++t) {
    const ParticleBlock none;
    const auto same = std::ranges::find(golden.blocks, matches[t].time, &ParticleBlock::time);
    const ParticleBlock& theirs = alone ? none : *same;
    const auto t_b = static_cast<std::size_t>(same - golden.blocks.begin());
    const detail::Pairs matched =
        alone ? detail::Pairs()
              : detail::match_particles(table, mine.blocks[t], theirs, cell, needs_partners);
    partial = partial || matched.size() < std::max(theirs.X.size(), mine.blocks[t].X.size());
    const auto exact_a = truth.at("A", mine.blocks[t]);
    const auto exact_b = alone || (truth.ends_at_rest() && !at_rest) ? std::nullopt : truth.at("B", theirs);
    for (const auto& field : alone ? exact_fields() : foreign_fields()) {
      if (!mine.has(field) || !(alone || golden.has(field))) continue;
      if (!options.fields.empty() && std::ranges::find(options.fields, field) == options.fields.end())
        continue;
      ForeignCurves curves{.field = field,
                           .time = matches[t].time,
                           .X_a = mine.blocks[t].X,
                           .a = mine.values(field, t),
                           .X_b = theirs.X,
                           .b = alone ? std::vector<double>() : golden.values(field, t_b),
                           .exact_a = exact_values(exact_a, field),
                           .exact_b = exact_values(exact_b, field),
                           .X_matched = {},
                           .difference = {},
                           .pairs = matched};
      if (options.exact.contains(field) && curves.exact_a.empty()) {
        table.fault("missing exact solutions",
                    "the exact " + field + " at time " + to_text(curves.time) + " is not known");
      }
      result.curves.push_back(std::move(curves));
    }
  }

  // 4. The figures, field by field.
  std::vector<std::optional<ReferenceFields>> overview;
  if (alone && !result.curves.empty() && !result.curves[0].exact_a.empty())
    for (auto& fields : truth.overview(result.curves[0].X_a)) overview.emplace_back(std::move(fields));
  for (ForeignCurves& curves : result.curves) {
    double scale = alone ? 0.0 : golden.largest(curves.field);
    for (const auto& exact : overview)
      for (const double value : exact_values(exact, curves.field)) scale = std::max(scale, std::abs(value));
    for (const double value : alone ? curves.exact_a : std::vector<double>())
      scale = std::max(scale, std::abs(value));
    result.fields.push_back(compare_field(options, curves, scale));
  }
  const auto place = [](const auto& item) { return std::ranges::find(foreign_fields(), item.field); };
  std::ranges::stable_sort(result.fields, {}, place);
  std::ranges::stable_sort(result.curves, {}, place);
  result.reference = truth.description();
  result.reference_error = truth.own_error();
  result = judged(std::move(result), faults, notes, partial);
  if (result.verdict == Verdict::different)
    result.hints = detail::mistakes(result, table.times(), times, truth.scene());
  return result;
}

}  // namespace hompm
