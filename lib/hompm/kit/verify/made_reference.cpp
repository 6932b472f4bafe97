#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <hompm/effects/registry.hpp>
#include <hompm/error.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/verify/made_reference.hpp>
#include <hompm/numerics/cubic_spline.hpp>
#include <hompm/numerics/elementary.hpp>
#include <hompm/scheme/scheme.hpp>

namespace hompm {
namespace {

/// How the reference is made.
struct Candidate {
  bool own;  ///< by the scheme of the scene
  TimeIntegrator integrator;
  double step_fraction;
};

/// Takes the place of the scheme of a body.
void rediscretise(const Candidate& candidate, int cells, Scene& body) {
  SchemeSpec& scheme = body.scheme;
  const double margin = std::ceil(1.0 * scheme.margin_cells * cells / scheme.cells);
  scheme.margin_cells = static_cast<int>(std::min(margin, 1e7));
  scheme.cells = cells;
  scheme.time_step.reset();
  scheme.courant.reset();
  scheme.step_fraction = candidate.step_fraction;
  scheme.allow_unstable = false;
  if (!candidate.own) {
    const Scheme& best = find_scheme("high-order");
    const MaterialSpec& material = body.material;
    scheme.name = best.name;
    scheme.degree = best.default_degree;
    scheme.particles_per_cell = 4;
    scheme.choices = best.choices;
    scheme.choices.time_integrator = candidate.integrator;
    scheme.relaxation_rate =
        numerics::pi * std::sqrt(material.youngs_modulus / material.density) / body.body.length;
  }
  scheme.margin_cells = std::max({scheme.margin_cells, scheme.degree + 2, (cells + 3) / 4});
}

/// The scene up to `end_time` (s) with as many cells in each body. Throws `SceneError` where it does not go
/// with the candidate.
Scene remade(Scene scene, const Candidate& candidate, const std::vector<int>& cells, double end_time) {
  scene.end_time = end_time;
  scene.rest.reset();
  scene.output = {.snapshots = 1, .history = 1};
  const auto* const effects = &effects_of(scene);
  rediscretise(candidate, cells.front(), scene);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    scene.bodies[i].end_time = end_time;
    rediscretise(candidate, cells[i], scene.bodies[i]);
  }
  return parse_scene(scene_text(scene), "reference", {}, *effects);
}

/// The fields of a run as functions of X, at the particles of another: cubic splines, each body by itself.
ReferenceFields fields_at(const Snapshot& from, const Snapshot& at) {
  ReferenceFields fields;
  const auto end_of_body = [](const Snapshot& snapshot, std::size_t first) {
    std::size_t i = first;
    while (i < snapshot.size() && (snapshot.body.empty() || snapshot.body[i] == snapshot.body[first])) ++i;
    return i;
  };
  for (std::size_t first = 0, point = 0; first < from.size();) {
    const std::size_t count = end_of_body(from, first) - first;
    const std::size_t end = end_of_body(at, point);
    const auto part = [&](const std::vector<double>& values) {
      return std::span(values).subspan(first, count);
    };
    numerics::CubicSplineSites sites(count);
    static_cast<void>(sites.factorise(part(from.reference_position)));  // X is in order
    const auto add = [&](const std::vector<double>& values, std::vector<double>& to) {
      numerics::CubicSplineSites::Fit fit(count);
      fit.values = part(values);
      sites.fit(fit.values, fit);
      for (std::size_t i = point, hint = 0; i < end; ++i) {
        const auto weights = sites.weights(at.reference_position[i], hint);
        hint = weights.interval;
        to.push_back(numerics::CubicSplineSites::evaluate(weights, fit));
      }
    };
    for (const ErrorField& field : error_fields) add(from.*field.values, fields.*field.exact);
    first += count;
    point = end;
  }
  return fields;
}

constexpr double two_grids = 3.0;  // factors of safety
constexpr double three_grids = 1.25;
constexpr double least_order = 0.2;  // at a jump a scheme of order p has p/(2 (p + 1)), 1/3 of the second
constexpr double smooth_order = 1.5;

/// That may be made use of: coarse grids show that of space, fine ones that of time, which is 1 where forces
/// depend on velocities.
double highest_order(const Scene& scene, TimeIntegrator integrator) {
  const SmallMotion motion = small_motion(scene);
  const bool damped = motion.damping_rate > 0.0 || motion.viscous_time > 0.0 || motion.force_factor > 1.0;
  if (damped || integrator == TimeIntegrator::euler_cromer) return 1.0;
  return integrator == TimeIntegrator::leapfrog ? 2.0 : 2.5;
}

struct Estimate {
  double own = 0.0;
  double order = std::numeric_limits<double>::infinity();
};

/// From a field on grids of which each is twice as fine as the one before.
Estimate own_error(const std::vector<const std::vector<double>*>& grids, double highest_order) {
  std::vector<std::vector<double>> steps;  // from grid to grid
  std::vector<double> sizes;
  for (std::size_t i = 1; i < grids.size(); ++i) {
    steps.push_back(*grids[i]);
    for (std::size_t k = 0; k < steps.back().size(); ++k) steps.back()[k] -= (*grids[i - 1])[k];
    sizes.push_back(detail::rms(steps.back()));
  }
  const std::size_t n = sizes.size();
  const double last = sizes[n - 1];
  if (last == 0.0) return {};
  if (n < 2) return {two_grids * last, 0.0};
  const auto order_at = [&](std::size_t i) {
    return sizes[i - 1] > 0.0 ? numerics::log(sizes[i - 1] / std::max(sizes[i], 1e-300)) / numerics::log(2.0)
                              : 0.0;
  };
  // Where there is more than one, the lower: errors of different orders may cancel in one of them.
  double order = order_at(n - 1);
  if (n > 2) order = std::min(order, std::max(order_at(n - 2), least_order));
  const double larger = order >= least_order ? last : std::max(last, sizes[n - 2]);
  double aligned = 0.0;
  for (std::size_t k = 0; k < steps[n - 1].size(); ++k) aligned += steps[n - 1][k] * steps[n - 2][k];
  if (order < smooth_order && aligned < 0.0) return {three_grids * larger, order};
  if (!(order >= least_order)) return {2.0 * two_grids * larger, order};
  const double used = std::min(order, highest_order);
  return {last * std::min(two_grids, three_grids / (numerics::exp(used * numerics::log(2.0)) - 1.0)), order};
}

/// The report against the finest of two grids at least.
ErrorReport report_of(const Scene& scene, const Snapshot& final, const std::vector<ReferenceFields>& levels,
                      const Candidate& candidate, std::int64_t cells, const RunMotion& motion) {
  ReferenceErrors own;
  double order = std::numeric_limits<double>::infinity();
  const double highest = highest_order(scene, candidate.integrator);
  for (const ErrorField& field : error_fields) {
    std::vector<const std::vector<double>*> grids;
    grids.reserve(levels.size());
    for (const ReferenceFields& level : levels) grids.push_back(&(level.*field.exact));
    const Estimate estimate = own_error(grids, highest);
    own.*field.error = estimate.own;
    order = std::min(order, estimate.order);
  }
  ErrorReport report = detail::report_of(scene, final, levels.back(), own, motion);
  report.kind = order >= smooth_order ? ErrorKind::computed : ErrorKind::extrapolated;
  report.reference = "runs by " + (candidate.own ? scene.scheme.name : std::string("high-order")) +
                     (candidate.integrator == TimeIntegrator::blanes_moan ? " with blanes-moan" : "") +
                     " on up to " + std::to_string(cells) + " cells";
  if (report.kind == ErrorKind::extrapolated)
    report.reference += levels.size() > 2 ? ", halved, with a safety factor of 1.25"
                                          : ", halved once, with a safety factor of 3";
  return report;
}

}  // namespace

double counted_work(const Scene& scene, const TimeStepping& stepping) {
  const SchemeChoices& choices = scene.scheme.choices;
  const double each = reconstructs(choices.quadrature) ? 200.0 : 80.0;  // ns, about what was measured
  double particles = 0.0;
  for (const Scene* body : bodies_of(scene))
    particles += static_cast<double>(body->scheme.cells) * body->scheme.particles_per_cell;
  return particles * static_cast<double>(stepping.steps) * each *
         static_cast<double>(splitting(choices.time_integrator).drifts.size());
}

double reference_budget(const Scene& scene, const TimeStepping& stepping, bool full) {
  const double run = counted_work(scene, stepping);
  return full ? std::max(10.0 * run, 1e10) : std::max(0.2 * run, 3e8);
}

std::optional<ErrorReport> judge_by_runs(const Scene& scene, const RunResult& result, double budget,
                                         std::string& reason, const ReferenceWatch& watch,
                                         const RunMotion& motion) {
  const Snapshot& final = result.final;
  const std::vector<const Scene*> bodies = bodies_of(scene);
  const double own_fraction = std::min(0.2, result.largest_step_fraction);
  const std::array candidates{Candidate{false, TimeIntegrator::blanes_moan, 0.6},
                              Candidate{false, TimeIntegrator::leapfrog, 0.2},
                              Candidate{true, scene.scheme.choices.time_integrator, own_fraction}};
  int fewest = bodies.front()->scheme.cells;
  for (const Scene* body : bodies) fewest = std::min(fewest, body->scheme.cells);
  double spent = 0.0;
  bool beyond = false;
  std::string refused;
  for (const Candidate& candidate : candidates) {
    std::vector<ReferenceFields> levels;  // coarse to fine
    std::optional<ErrorReport> report;
    constexpr int coarsest = 4;
    constexpr int most_levels = 12;
    constexpr int most_cells = 1'000'000;
    constexpr std::size_t enough_levels = 4;
    for (int level = 0; level < most_levels; ++level) {
      std::vector<int> cells;
      cells.reserve(bodies.size());
      for (const Scene* body : bodies)
        cells.push_back(std::max(coarsest, body->scheme.cells * coarsest / fewest) << level);
      const auto all_cells = std::accumulate(cells.begin(), cells.end(), std::int64_t{0});
      beyond = all_cells > most_cells;
      if (beyond) break;
      std::optional<Scene> made;
      try {
        made = remade(scene, candidate, cells, final.time);
        const TimeStepping stepping = time_stepping(*made);
        const double work = counted_work(*made, stepping);
        beyond = spent + work > budget;
        if (beyond) break;
        spent += work;
        RunObserver observer;
        if (watch)
          observer.progress = [&](std::int64_t step, std::int64_t steps) {
            const double done = static_cast<double>(step) / static_cast<double>(steps);
            watch(std::min(1.0, (spent - work * (1.0 - done)) / budget));
          };
        levels.push_back(fields_at(run(*made, stepping, observer).final, final));
      } catch (const Error& error) {
        refused = error.what();
        report.reset();
        // As on every grid; or a fine one fails, which coarse ones hide. Else it may be too coarse for a
        // load.
        if (!made || !levels.empty() || cells.front() >= bodies.front()->scheme.cells) break;
        continue;
      }
      if (levels.size() < 2) continue;
      report = report_of(scene, final, levels, candidate, all_cells, motion);
      if (levels.size() >= enough_levels && std::ranges::all_of(error_fields, [&](const ErrorField& field) {
            const double own = report->reference_errors.*field.error;
            return own <= 0.1 * (report->bound.*field.error - own);
          }))
        break;
    }
    if (report) return report;
    if (beyond) break;
  }
  reason = beyond ? "two runs to compare with are beyond the work allowed; --errors full allows more"
                  : "no scheme could run it on two grids: " + refused;
  return std::nullopt;
}

}  // namespace hompm
