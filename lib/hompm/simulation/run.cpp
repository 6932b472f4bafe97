#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <hompm/number.hpp>
#include <hompm/numerics/floating_point.hpp>
#include <hompm/plan/invalid.hpp>
#include <hompm/simulation/guards.hpp>
#include <hompm/simulation/probes.hpp>
#include <hompm/simulation/run.hpp>
#include <hompm/simulation/warnings.hpp>

namespace hompm {
namespace {

/// True after `step` steps if one of `count` outputs, evenly spaced over `steps`, is due: output k comes
/// after the whole number of steps nearest to k steps/count.
bool is_due(std::int64_t step, std::int64_t steps, std::int64_t count) {
  const std::int64_t k = (step * count + steps / 2) / steps;
  return k >= 1 && (2 * k * steps + count) / (2 * count) == step;
}

/// Tells when no particle has moved faster than the scene's `rest.speed` for the time a wave takes there and
/// back, while no load changed and no gap was to close before the end time. By positions, not velocities:
/// what a particle's velocity has beyond the grid's moves nothing, and what the grid's has is taken back
/// where relaxation balances it.
class RestWatch {
 public:
  RestWatch(const Scene& scene, double time_step, const std::vector<State>& states, std::int64_t quiet_steps)
      : longest_way_(scene.rest->speed * time_step),
        earliest_(scene.rest->earliest.value_or(0.0)),
        end_time_(scene.end_time),
        quiet_steps_(quiet_steps) {
    for (const State& state : states) before_.push_back(state.particles.displacement);
    double longest = 0.0;
    for (const Scene* body : bodies_of(scene)) {
      const double wave_speed = std::sqrt(body->material.youngs_modulus / body->material.density);
      longest = std::max(longest, 2.0 * body->body.length / wave_speed);
      settled_from_ = std::max(settled_from_, outlook(*body).settled_from);
    }
    steps_needed_ = static_cast<std::int64_t>(std::ceil(longest / time_step));
  }
  bool at_rest(const Simulation& simulation) {
    const std::vector<State>& states = simulation.states();
    const double time = states.front().time;
    bool quiet = time >= settled_from_;
    longest_ = 0.0;
    for (std::size_t body = 0; body < before_.size(); ++body) {
      const auto& displacement = states[body].particles.displacement;
      auto& before = before_[body];
      for (std::size_t i = 0; i < before.size(); ++i) {
        const double way = std::abs(displacement[i] - before[i]);
        quiet = quiet && way <= longest_way_;
        longest_ = std::max(longest_, way);
        before[i] = displacement[i];
      }
    }
    quiet = quiet && !(time + simulation.next_meeting() < end_time_);
    quiet_steps_ = quiet ? quiet_steps_ + 1 : 0;
    return quiet_steps_ >= steps_needed_ && time >= earliest_;
  }
  [[nodiscard]] std::int64_t quiet_steps() const { return quiet_steps_; }
  /// The longest way of a particle in the last step, m.
  [[nodiscard]] double longest() const { return longest_; }

 private:
  double longest_way_;          ///< m, in one step
  double settled_from_ = 0.0;   ///< s
  double earliest_, end_time_;  ///< s
  std::vector<std::vector<double>> before_;
  double longest_ = 0.0;
  std::int64_t steps_needed_;
  std::int64_t quiet_steps_;
};

/// What helps where a front is too steep. What comes to a stop at once, at an end or another body, makes a
/// shock, which is the steeper the more particles there are.
std::string help_for_steep_front(const Scene& scene) {
  const auto bodies = bodies_of(scene);
  const bool spread = std::ranges::any_of(
      scene.effects, [](const EffectSpec& spec) { return spec.type == "bulk-viscosity"; });
  const bool stopped = std::ranges::any_of(bodies, [](const Scene* body) {
    const auto& velocity = body->initial_velocity;
    const auto moves = [&](double place) {
      return velocity && velocity->at(place, body->body.length) != 0.0;
    };
    return (body->ends.left == End::fixed && moves(0.0)) || (body->ends.right == End::fixed && moves(1.0)) ||
           std::ranges::any_of(body->effects,
                               [&](const EffectSpec& spec) { return find_effect(*body, spec).holds_end; });
  });
  if (!stopped) return ", use more of them";
  return std::string(": a shock, which more of them make steeper; ") +
         (spread ? "raise the coefficients of the effect bulk-viscosity"
                 : "the effect bulk-viscosity spreads it") +
         (scene.scheme.name == "high-order" ? "" : ", or take scheme.name = \"high-order\"");
}

/// The same, with the cause where the watch on the critical step knows it.
[[noreturn]] void throw_with_cause(const InvalidRun& error, double step_fraction) {
  if (!(step_fraction > 1.0)) throw error;
  throw InvalidRun(
      error.step, error.time, error.particle,
      error.reason + "; here the time step is too large, " + to_text(step_fraction) + " of the critical one");
}

/// What is not a finite number in an output: "density of particle 3"; "" where all is.
std::string not_finite(const Snapshot& snapshot, const HistoryRow& row) {
  const auto first_bad = [](std::string_view name, const std::vector<double>& values) -> std::string {
    const auto bad = std::ranges::find_if_not(values, [](double value) { return std::isfinite(value); });
    return bad == values.end() ? ""
                               : std::string(name) + " of particle " + std::to_string(bad - values.begin());
  };
  std::string bad;
  for (const auto& column : detail::all_columns)
    if (bad.empty()) bad = first_bad(column.name, snapshot.*column.values);
  for (const ReportedField& field : snapshot.reported)
    if (bad.empty()) bad = first_bad(field.name, field.values);
  if (!bad.empty()) return bad;
  for (const auto& column : detail::history_columns)
    if (!std::isfinite(row.*column.value)) return std::string(column.name) + " in the balances";
  return "";
}

void accumulate(RunExtremes& result, const HistoryRow& row) {
  const auto raise = [](double& largest, double value) { largest = std::max(largest, std::abs(value)); };
  raise(result.largest_residual, row.residual);
  raise(result.largest_momentum_residual, row.momentum_residual);
  raise(result.largest_internal_force_sum, row.internal_force_sum);
  raise(result.largest_energy, row.kinetic + row.stored + std::abs(row.gravity));
  raise(result.largest_momentum, std::abs(row.momentum) + std::abs(row.impulse));
}

/// Of the bodies with a law for small strains, |λ − 1|.
double largest_strain(const Simulation& simulation) {
  double largest = 0.0;
  for (const State& state : simulation.states())
    if (!state.moves)
      for (const double stretch : state.particles.stretch)
        largest = std::max(largest, std::abs(stretch - 1.0));
  return largest;
}

}  // namespace

RunResult run(const Scene& scene, const TimeStepping& stepping, const RunObserver& observer,
              const RunPoint* from) {
  numerics::check_floating_point();
  Simulation simulation(scene, stepping.time_step);
  detail::StepWatch step_watch(scene);
  const double scale = detail::energy_scale(scene, simulation.states());
  const bool probed = observer.probe && !scene.probes.empty();
  RunResult result;
  result.start = result.end = simulation.history(0.0);
  if (from != nullptr) {
    for (std::size_t body = 0; body < simulation.bodies(); ++body)
      simulation.state(body) = from->states.at(body);
    static_cast<RunExtremes&>(result) = from->extremes;
  } else {
    accumulate(result, result.start);
    result.largest_strain = largest_strain(simulation);
    result.largest_step_fraction = stepping.time_step / stepping.critical_time_step;
    result.largest_wave_speed = step_watch.fastest_wave(simulation.states());
    const Snapshot start = simulation.snapshot(0.0);
    if (const std::string bad = not_finite(start, result.start); !bad.empty())
      throw SceneError(
          Origin{"scene"},
          "cannot be started: " + bad + " is not finite at t = 0; its numbers are too large or too small");
    if (observer.history) observer.history(result.start);
    if (observer.snapshot) observer.snapshot(start);
    if (probed)
      detail::tell_probes(
          scene, start, [](const ProbeSpec&) { return true; }, observer.probe);
  }

  result.warnings = warnings_before(scene, stepping);
  detail::Guards guards(result.start, from != nullptr ? from->supplied : 0.0, scale);
  std::optional<RestWatch> rest;
  if (scene.rest)
    rest.emplace(scene, stepping.time_step, simulation.states(), from != nullptr ? from->quiet_steps : 0);
  if (observer.start) observer.start(simulation);

  try {
    for (std::int64_t step = simulation.state().step + 1; step <= stepping.steps && !result.at_rest; ++step) {
      simulation.step(stepping.time_step);
      result.steps = step;
      step_watch.look(simulation.states(), result);
      guards.look(simulation);

      result.at_rest = rest && rest->at_rest(simulation);
      const bool last = step == stepping.steps || result.at_rest;
      const bool row_due = last || is_due(step, stepping.steps, scene.output.history);
      const bool snapshot_due = last || is_due(step, stepping.steps, scene.output.snapshots);
      constexpr std::int64_t between_looks = 128;
      if (row_due || step % between_looks == 0)
        result.largest_strain = std::max(result.largest_strain, largest_strain(simulation));
      const auto is_probed = [&](const ProbeSpec& probe) {
        return last || is_due(step, stepping.steps, probe.rows.value_or(scene.output.history));
      };
      const bool probe_due = probed && std::ranges::any_of(scene.probes, is_probed);
      if (row_due || snapshot_due || probe_due) {
        const double time = stepping.time(step, scene.end_time);
        result.end = simulation.history(time);
        guards.check(simulation, result.end);  // before anything is reported
        accumulate(result, result.end);
        result.least_dissipated = std::min(result.least_dissipated, detail::least_taken(simulation).energy);
        Snapshot snapshot;
        if (snapshot_due || probe_due) snapshot = simulation.snapshot(time);
        if (const std::string bad = not_finite(snapshot, result.end); !bad.empty())
          throw InvalidRun(step, time, -1,
                           bad + " is not finite");  // LCOV_EXCL_LINE: densities that overflow
        if (row_due && observer.history) observer.history(result.end);
        if (snapshot_due && observer.snapshot) observer.snapshot(snapshot);
        if (probe_due) detail::tell_probes(scene, snapshot, is_probed, observer.probe);
        if (last) result.final = std::move(snapshot);
      }
      if (observer.progress) observer.progress(step, stepping.steps);
      result.stopped = !last && observer.stop && observer.stop();
      const bool due = last ? observer.checkpoint_at_end
                            : observer.checkpoint_every > 0 && step % observer.checkpoint_every == 0;
      if (observer.checkpoint && (due || result.stopped))
        observer.checkpoint({simulation.states(), static_cast<const RunExtremes&>(result), guards.supplied(),
                             rest ? rest->quiet_steps() : 0});
      if (result.stopped) break;
    }
  } catch (const detail::SteepFront& error) {
    throw_with_cause({error.step, error.time, error.particle, error.reason + help_for_steep_front(scene)},
                     result.largest_step_fraction);
  } catch (const InvalidRun& error) {
    throw_with_cause(error, result.largest_step_fraction);
  }
  if (rest) result.last_speed = rest->longest() / stepping.time_step;
  for (Warning& found : warnings_after(result, scale)) result.warnings.push_back(std::move(found));
  return result;
}

}  // namespace hompm
