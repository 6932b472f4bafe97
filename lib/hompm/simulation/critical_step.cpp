#include <algorithm>
#include <cmath>
#include <string>

#include <hompm/numerics/spectral_radius.hpp>
#include <hompm/scheme/join_scheme.hpp>
#include <hompm/simulation/critical_step.hpp>

namespace hompm {
namespace {

/// Trace of one step of length z of the oscillator x'' = −x: stable where it is between −2 and 2.
double trace(const Splitting& splitting, double z) {
  double xx = 1.0, xv = 0.0, vx = 0.0, vv = 1.0;  // the step as a matrix
  for (std::size_t part = 0; part < splitting.kicks.size(); ++part) {
    const double kick = splitting.kicks[part] * z;
    vx -= kick * xx;
    vv -= kick * xv;
    if (part == splitting.drifts.size()) break;
    const double drift = splitting.drifts[part] * z;
    xx += drift * vx;
    xv += drift * vv;
  }
  return xx + vv;
}

/// The z = ω Δt up to which the oscillator x'' = −ω² x is stable: 2 for Euler–Cromer and leapfrog. A
/// fourth-order splitting can have narrow bands of weak growth before its last limit (blanes-moan: 3.1635
/// to 3.1685); the scan is finer than those.
double largest_stable_phase(const Splitting& splitting) {
  constexpr double scan = 1e-3;
  const auto stable = [&](double z) { return std::abs(trace(splitting, z)) <= 2.0 + 1e-9; };
  double low = 0.0;
  while (stable(low + scan)) low += scan;
  double high = low + scan;
  for (int round = 0; round < 40; ++round) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

/// A body of few cells that has the ends of the scene: what happens there does not depend on the rest.
Scene ends_of(const Scene& scene) {
  constexpr int enough = 16;
  Scene ends = scene;
  const int cells = std::min(scene.scheme.cells, enough);
  const double width = scene.body.length / scene.scheme.cells;
  ends.body.length = scene.body.length * cells / scene.scheme.cells;
  ends.scheme.cells = cells;
  ends.scheme.margin_cells = scene.scheme.degree + 2;
  ends.grid = {};
  if (auto& displacement = ends.initial_displacement) {
    // The same stretch at the ends; where they are does not count, but they must be on the grid.
    displacement->amplitude *= displacement->shape == "sine" ? ends.body.length / scene.body.length : 0.0;
    const double longer = std::max(0.0, displacement->at(1.0, ends.body.length));
    ends.scheme.margin_cells += static_cast<int>(std::ceil(longer / width));
  }
  return ends;
}

/// The state at t = 0 with the fields of the scheme, but none of effects.
State start_state(const Scene& scene) {
  State state = initial_state(scene);
  Plan plan;
  join_scheme(make_material(scene.material), {scene, scene.scheme, state, plan, ""});
  return state;
}

}  // namespace

CriticalStep::CriticalStep(const Scene& scene)
    : phase_(largest_stable_phase(splitting(scene.scheme.choices.time_integrator))),
      effects_(small_motion(scene)),
      relaxation_rate_(scene.scheme.relaxation_rate),
      linear_(scene) {
  if (scene.scheme.choices.sequence != Sequence::usl) return;
  // Dampings see the grid velocity with the kick as it is, smoothed by nothing: at most twice as strong.
  effects_.damping_rate *= 2.0;
  effects_.viscous_time *= 2.0;
}

double CriticalStep::at(const State& state) {
  linear_.linearise(state);
  return of_linearised();
}

double CriticalStep::with_cut(const State& state, double cut) {
  linear_.linearise_with_cut(state, cut);
  return of_linearised();
}

double CriticalStep::of_linearised() {
  // The square root halves the error, and a value that has settled to a tolerance is known to a few of them.
  constexpr double tolerance = 0.004;
  constexpr int most_rounds = 100;
  const auto radius = numerics::spectral_radius(
      linear_.size(), [&](const auto& stress, auto& result) { linear_.apply(stress, result); }, tolerance,
      most_rounds);
  // A mode that is pushed away from rest grows with every step.
  constexpr double pushed = 0.05;
  if (radius.rightmost > pushed * radius.value)
    throw InvalidRun(0, 0.0, -1,
                     "no step is stable: the forces drive some motions instead of holding them back; "
                     "raise scheme.particles_per_cell, or lower scheme.degree");
  // A force that grows by the factor acts as a stiffness that does.
  const double omega2 = radius.value * effects_.force_factor;
  // v' = v − Δt (ω² σ + 2 b v), σ' = σ + Δt v' is stable up to Δt² ω² + 4 Δt b = 4 (docs/stability.md).
  const double b = 0.5 * (effects_.viscous_time * omega2 + effects_.damping_rate);
  const double limit = phase_ / (b + std::sqrt(b * b + omega2));
  // u += Δt/τ (û − u) turns the hidden part of u around at Δt = τ, and lets it grow from 2 τ on.
  return limit * relaxation_rate_ > 2.0 ? 2.0 / relaxation_rate_ : limit;
}

bool moving_free_end(const Scene& scene) {
  const bool free = scene.ends.left == End::free || scene.ends.right == End::free;
  return free && scene.kinematics == Kinematics::finite &&
         scene.scheme.choices.formulation == Formulation::updated_lagrangian;
}

namespace {

[[noreturn]] void refuse(const Scene& scene, const std::string& why) {
  throw SceneError(scene.origin_of("scheme.particles_per_cell"), why);
}

/// Of the ends of the scene as if nothing held them.
double limit_of_free_ends(const Scene& scene) {
  const auto or_refused = [&](const std::string& what, auto limit) {
    try {
      return limit();
    } catch (const InvalidRun& error) {
      refuse(scene, what + error.reason);
    }
  };
  const State start = Simulation(scene, 1.0).state();
  double least = or_refused("the scene cannot be started: ", [&] { return CriticalStep(scene).at(start); });
  if (!moving_free_end(scene)) return least;

  const Scene few_cells = ends_of(scene);
  const State ends = start_state(few_cells);
  CriticalStep critical(few_cells);
  const double spacing = 1.0 / scene.scheme.particles_per_cell;
  for (const double cut : {1e-6, 0.5 * spacing + 0.02, 1.5 * spacing + 0.02})
    least = std::min(least, or_refused("a free end cannot move through the grid: ",
                                       [&] { return critical.with_cut(ends, cut - std::floor(cut)); }));
  return least;
}

}  // namespace

double critical_time_step(const Scene& scene) {
  const double limit = limit_of_free_ends(scene);
  if (!detail::has_held_ends(scene)) return limit;
  const Scene few_cells = ends_of(scene);
  constexpr double steps = 4000.0;  // what grows less than e times in a thousand is left to the guards
  for (const double part : {1.0, 0.75, 0.5})
    if (detail::stays_bounded(few_cells, 0.98 * part * limit, static_cast<int>(steps / part)))
      return part * limit;
  refuse(
      scene,
      "no step is stable with the ends held so: motions grow there that the particles do not resolve; raise "
      "scheme.particles_per_cell, or lower scheme.degree");
}

}  // namespace hompm
