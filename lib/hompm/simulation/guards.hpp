// What watches a run: whether it is still one that a body could do, and how the critical step changes.
#pragma once

#include <string_view>
#include <vector>

#include <hompm/simulation/critical_step.hpp>
#include <hompm/simulation/run.hpp>

namespace hompm::detail {

/// Stretches, positions on the grid and what reconstruction needs are looked at by the stages that use them,
/// in every step. This looks at the rest: every particle's velocity and stress finite, particles in order,
/// and no more energy than the start and the loads supplied. Throws `InvalidRun`.
///
/// The bound of the energy is ten times what was supplied. Unstable steps double the energy every few steps
/// and pass any bound; what must not be stopped is a run that its scheme merely does badly, and FLIP with a
/// shock has been seen to settle at nine times its energy (docs/stability.md, "Long runs"). Loads that have
/// only begun to act count with what they may supply. What can only take energy may not give as much.
class Guards {
 public:
  /// `start` is the first row of the run, `supplied` the largest energy that loads had supplied so far,
  /// `scale` that of the scene (J/m²).
  Guards(const HistoryRow& start, double supplied, double scale)
      : start_(start.kinetic + start.stored), supplied_(supplied), scale_(scale) {}

  /// After each step; looks at every 128th, and then at what can be had in one pass: kinetic energy.
  void look(const Simulation& simulation);

  /// Before anything of the present step is reported, with its row.
  void check(const Simulation& simulation, const HistoryRow& row);

  [[nodiscard]] double supplied() const { return supplied_; }

 private:
  void compare(const Simulation& simulation, double energy, const HistoryRow& row);

  double start_;
  double supplied_;
  double scale_;
};

/// Of what can only take energy, all of it or an effect by itself, the least that was taken, J/m²: below 0
/// some was given.
struct LeastTaken {
  double energy = 0.0;
  std::string_view by;  ///< "by wall"; empty for all
};
LeastTaken least_taken(const Simulation& simulation);

/// What the loads of a scene may supply, and what rounding of positions may store, J/m².
double energy_scale(const Scene& scene, const std::vector<State>& states);

/// Computes the critical step again when waves have become faster, or after so many steps that it costs less
/// than 1 % of them, and raises `largest_step_fraction`. What it does depends on states and extremes alone,
/// so that a resumed run goes on with the same bits. Nothing moves with infinitesimal kinematics, and nothing
/// is looked at.
class StepWatch {
 public:
  /// The scene must outlive it.
  explicit StepWatch(const Scene& scene);

  /// Speed of the fastest waves in the bodies, m/s: √(dσ/dε / ρ), total Lagrangian √(dσ/dλ / ρ0).
  [[nodiscard]] double fastest_wave(const std::vector<State>& states) const;

  /// After each step.
  void look(const std::vector<State>& states, RunExtremes& extremes);

 private:
  bool moves_;
  std::vector<const Scene*> bodies_;
  std::vector<Material> materials_;
  std::vector<CriticalStep> critical_;  ///< of each body; empty before the first check
};

}  // namespace hompm::detail
