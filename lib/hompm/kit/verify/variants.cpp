#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/verify/foreign_matching.hpp>
#include <hompm/kit/verify/variants.hpp>
#include <hompm/number.hpp>
#include <hompm/simulation/run.hpp>

namespace hompm {
namespace {

using detail::ParticleBlock;
using detail::ParticleFields;
using detail::ParticleTable;
using Changes = std::vector<std::pair<std::string, std::string>>;

/// The file, and what of it lies on steps of the scene.
struct Held {
  ParticleTable& table;
  std::vector<double> times;  ///< of A
  ParticleFields fields;      ///< at these
};

/// Whether `time` (s) is a whole number of `parts` of the run.
bool on_part(double time, double end_time, double parts) {
  const double part = time / end_time * parts;
  return std::abs(part - std::round(part)) <= 1e-6 * std::max(1.0, part);
}

/// The least number of snapshots, a divisor of the number of steps, of which each of `times` is one.
std::int64_t snapshots_for(const std::vector<double>& times, double end_time, std::int64_t steps) {
  for (std::int64_t n = 1; n < steps; ++n) {
    const auto is_one = [&](double time) { return on_part(time, end_time, static_cast<double>(n)); };
    if (steps % n == 0 && std::ranges::all_of(times, is_one)) return n;
  }
  return steps;
}

ParticleBlock block_of(const Snapshot& snapshot) {
  return {snapshot.time,
          snapshot.body,
          snapshot.reference_position,
          {snapshot.position, snapshot.displacement, snapshot.velocity, snapshot.volume, snapshot.density,
           snapshot.stress, snapshot.stretch}};
}

/// Differences by field, and where the two part first.
void compare(const Held& a, const ParticleFields& run, double time_step, double cell, double excused,
             SchemeVariant& result) {
  constexpr double unknown = std::numeric_limits<double>::infinity();
  std::map<std::string, double> worst;
  for (std::size_t t = 0; t < run.blocks.size(); ++t) {
    const ParticleBlock& theirs = run.blocks[t];
    const auto mine = std::ranges::min_element(
        a.fields.blocks, {}, [&](const auto& block) { return std::abs(block.time - theirs.time); });
    const auto t_a = static_cast<std::size_t>(mine - a.fields.blocks.begin());
    const auto pairs = detail::match_particles(a.table, *mine, theirs, cell, false);
    double furthest = result.step < 0 ? excused : unknown;
    for (const auto& field : a.fields.names) {
      if (field == "x" && a.fields.has("displacement")) continue;  // the displacement tells more
      const double scale = run.largest(field);
      double& most = worst[field];
      if (pairs.empty()) most = unknown;  // nothing was looked at
      for (const auto& [i, j] : pairs) {
        const double part =
            std::abs(a.fields.values(field, t_a)[i] - run.values(field, t)[j]) / (scale > 0.0 ? scale : 1.0);
        most = std::max(most, std::isnan(part) ? unknown : part);
        if (part <= furthest) continue;
        furthest = part;
        result.step = std::llround(theirs.time / time_step);
        result.time = theirs.time;
        result.X = theirs.X[j];
        result.field = field;
      }
    }
  }
  result.largest = worst.empty() ? unknown : 0.0;
  for (const auto& [field, part] : worst) result.largest = std::max(result.largest, part);
  result.differences = std::move(worst);
}

/// Runs the scene and holds A against it at the times that both have; `excused`, of the largest value, is no
/// difference.
SchemeVariant try_out(Scene scene, Changes changes, const Held& a, double excused = 1e-9) {
  SchemeVariant result{.changes = std::move(changes)};
  const TimeStepping stepping = time_stepping(scene);
  std::vector<double> times;
  for (const double time : a.times)
    if (on_part(time, scene.end_time, static_cast<double>(stepping.steps))) times.push_back(time);
  if (times.empty()) {
    result.refused = "none of its steps ends at a time of A";
    return result;
  }
  scene.output.snapshots = static_cast<int>(snapshots_for(times, scene.end_time, stepping.steps));
  ParticleFields fields{detail::particle_fields(), {}};
  RunObserver observer;
  const double near = 0.5 * stepping.time_step;
  bool seen_all = false;  // what comes after the last time of A is not looked at
  observer.stop = [&] { return seen_all; };
  observer.snapshot = [&](const Snapshot& snapshot) {
    seen_all = snapshot.time > times.back() - near;
    if (std::ranges::any_of(times, [&](double time) { return std::abs(time - snapshot.time) < near; }))
      fields.blocks.push_back(block_of(snapshot));
  };
  try {
    run(scene, stepping, observer);
  } catch (const InvalidRun& error) {
    result.refused = error.what();
    return result;
  }
  compare(a, fields, stepping.time_step, scene.body.length / scene.scheme.cells, excused, result);
  return result;
}

/// Each choice of scheme and law, as key and value.
Changes neighbours(const Scene& scene) {
  Changes all;
  for (const SceneKey& key : scene_keys()) {
    if (!key.path.starts_with("scheme.") && key.path != "material.law") continue;
    for (const std::string& word : key.words) all.emplace_back(key.path, word);
  }
  for (int degree = 1; degree <= 5; ++degree) all.emplace_back("scheme.degree", std::to_string(degree));
  for (const double factor : {0.5, 2.0})
    all.emplace_back("scheme.time_step", to_text(factor * time_stepping(scene).time_step));
  return all;
}

std::vector<Override> overrides(const Changes& changes) {
  std::vector<Override> all;
  for (const auto& [key, value] : changes)
    all.push_back({key, value, std::string("--set ").append(key).append("=").append(value)});
  return all;
}

}  // namespace

SchemeVariants scheme_variants(const std::filesystem::path& a, const std::filesystem::path& b,
                               const ForeignOptions& options,
                               const std::function<void(std::int64_t, std::int64_t)>& progress) {
  detail::MessageLog faults;
  detail::MessageLog notes;
  const auto load = [&](const Changes& changes) { return detail::scene_of(b, overrides(changes)); };
  const Scene scene = load({});
  if (scene.rest)
    throw OptionError("--which: the scene runs to rest, where variants of a scheme are not told apart");
  ParticleTable table(a, {.columns = options.columns, .direction = options.direction, .name = options.name},
                      faults, notes);
  Held held{table, {}, {}};
  const auto steps = static_cast<double>(time_stepping(scene).steps);
  for (const double time : table.times())
    if (time >= 0.0 && time <= scene.end_time * (1.0 + 1e-9) && on_part(time, scene.end_time, steps))
      held.times.push_back(std::min(time, scene.end_time));
  constexpr std::ptrdiff_t most = 20;
  if (std::ssize(held.times) > most)
    held.times.erase(held.times.begin() + most / 2, held.times.end() - most / 2);
  if (held.times.empty()) throw OptionError("--which: no time of A lies on a step of the scene");
  held.fields = {table.fields(), table.read(held.times)};
  if (!held.fields.has("displacement")) held.fields.derive_displacement();

  SchemeVariants result{.times = held.times};
  result.tried.push_back(try_out(scene, {}, held));
  const auto matched = [](const auto& part) { return part.second < std::numeric_limits<double>::infinity(); };
  if (const SchemeVariant& plain = result.tried.front();
      plain.refused.empty() && std::ranges::none_of(plain.differences, matched))
    throw FileError("cannot tell variants by " + (options.name.empty() ? a.string() : options.name) +
                    ": no particle has the X of one of the scene, or no value is a number");
  std::set<std::string> seen{scene_text(scene)};  // the same scene is run once
  const auto best = [&] {
    return *std::ranges::min_element(result.tried, {}, [](const auto& v) { return v.largest; });
  };
  constexpr std::size_t most_changes = 3;
  constexpr double gain = 0.63;  // a fifth of a digit: of two causes of one size, the first to go halves it
  constexpr double enough = 1e-11;  // what other orders of the same sums leave
  for (std::size_t round = 1; round <= most_changes && best().largest > enough; ++round) {
    const SchemeVariant from = best();
    if (from.changes.size() + 1 != round) break;  // the last change gave nothing
    const Changes more = neighbours(load(from.changes));
    for (std::size_t i = 0; i < more.size(); ++i) {
      if (progress) progress(static_cast<std::int64_t>(i), static_cast<std::int64_t>(more.size()));
      Changes changes = from.changes;
      changes.push_back(more[i]);
      try {
        const Scene changed = load(changes);
        if (!seen.insert(scene_text(changed)).second) continue;
        result.tried.push_back(try_out(changed, changes, held));
      } catch (const SceneError&) {
        ++result.refused;
        continue;
      }
      if (!result.tried.back().refused.empty()) {
        ++result.refused;
        result.tried.pop_back();
      }
    }
    if (best().largest > from.largest * gain) break;
  }
  // Where A leaves the scene as it is, by more than it leaves the variant that it agrees with.
  if (const double largest = best().largest; largest < 1e-6 && result.tried.front().refused.empty())
    result.tried.front() = try_out(scene, {}, held, std::max(1e-12, 10.0 * largest));
  std::stable_sort(result.tried.begin() + 1, result.tried.end(),
                   [](const auto& one, const auto& other) { return one.largest < other.largest; });
  result.notes = notes.messages();
  for (const auto& fault : faults.messages()) result.notes.push_back(fault);
  return result;
}

}  // namespace hompm
