// A scene under way: its state, its plan, and the steps.
#pragma once

#include <hompm/materials/material.hpp>
#include <hompm/plan/plan.hpp>
#include <hompm/scheme/scheme.hpp>
#include <hompm/simulation/records.hpp>

namespace hompm {

/// The stages that the scene and its scheme call for. Throws `SceneError` when they do not go together.
Plan make_plan(const Scene& scene, const State& state);

/// The initial state of a scene, with what its effects add and change.
State start_state(const Scene& scene);

class Simulation {
 public:
  /// State and plan at t = 0, with steps of `time_step` (s). Throws `SceneError` when scene and scheme do not
  /// go together.
  Simulation(const Scene& scene, double time_step);

  /// One time step. Throws `InvalidRun` when it cannot be carried out; the state is then of no use.
  void step();

  [[nodiscard]] const State& state() const { return state_; }
  [[nodiscard]] const Plan& plan() const { return plan_; }
  /// For tests, restarts and the linear stability analysis, which set fields of their own before a step.
  [[nodiscard]] State& state() { return state_; }
  /// For recorders, which add stages of their own before a step.
  [[nodiscard]] Plan& plan() { return plan_; }

  /// Particle fields and balances now, with time stamp `time` (s).
  [[nodiscard]] Snapshot snapshot(double time) const;
  [[nodiscard]] HistoryRow history(double time) const;

 private:
  [[nodiscard]] double total_energy(const HistoryRow& row) const;
  /// The kick that a step leaves to the next, as part of the step: ½ in leapfrog.
  [[nodiscard]] double closing_kick() const;
  /// The state with that kick done: velocities and momentum at the time of the positions.
  [[nodiscard]] State synchronised() const;

  Material material_;
  Splitting splitting_;
  State state_;
  Plan plan_;
  double start_energy_ = 0.0;
  double start_momentum_ = 0.0;
};

}  // namespace hompm
