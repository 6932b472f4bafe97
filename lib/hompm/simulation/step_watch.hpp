// Follows the critical step of a run as the configuration changes.
#pragma once

#include <vector>

#include <hompm/simulation/critical_step.hpp>
#include <hompm/simulation/run.hpp>

namespace hompm::detail {

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
