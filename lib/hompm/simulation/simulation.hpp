// A scene under way: its state, its plan, and the steps.
#pragma once

#include <span>
#include <vector>

#include <hompm/materials/material.hpp>
#include <hompm/plan/plan.hpp>
#include <hompm/scheme/scheme.hpp>
#include <hompm/simulation/records.hpp>

namespace hompm {

/// Each body of a scene has a state and a plan, and its own grid: bodies never mix in one velocity field.
/// They take the phases of a step together, and what they do to each other stands between.
class Simulation {
 public:
  /// State and plan at t = 0; `time_step` (s) is the length of the first step, where `step` is not told one.
  /// Throws `SceneError` when scene and scheme do not go together, and `Error` for a plan that cannot be run
  /// (`check_plan`).
  Simulation(const Scene& scene, double time_step);
  /// Of one body, with a state and a plan that were made otherwise.
  Simulation(const Scene& scene, double time_step, State state, Plan plan);

  /// One time step of the length (s), its first kick that which the last step has left to it and its own.
  /// Throws `InvalidRun` when it cannot be carried out; the state is then of no use.
  void step(double length);
  void step() { step(states_.front().time_step); }  ///< as long as the last one

  [[nodiscard]] std::size_t bodies() const { return states_.size(); }
  [[nodiscard]] const State& state(std::size_t body = 0) const { return states_[body]; }
  [[nodiscard]] const Plan& plan(std::size_t body = 0) const { return plans_[body]; }
  /// For tests, restarts and the linear stability analysis, which set fields of their own before a step.
  [[nodiscard]] State& state(std::size_t body = 0) { return states_[body]; }
  /// For recorders, which add stages of their own before a step.
  [[nodiscard]] Plan& plan(std::size_t body = 0) { return plans_[body]; }
  [[nodiscard]] std::vector<Coupling>& couplings() { return couplings_; }
  [[nodiscard]] const std::vector<State>& states() const { return states_; }
  [[nodiscard]] const std::vector<Coupling>& couplings() const { return couplings_; }

  /// Whether their states are the same, bit for bit.
  [[nodiscard]] bool operator==(const Simulation& other) const { return states_ == other.states_; }

  /// Particle fields and balances now, with time stamp `time` (s).
  [[nodiscard]] Snapshot snapshot(double time) const;
  [[nodiscard]] HistoryRow history(double time) const;
  /// How long, at the present velocities, until the next gap between an end and what it can meet is shut, s;
  /// infinite where none closes.
  [[nodiscard]] double next_meeting() const;

 private:
  void start(const Scene& scene, double time_step);
  [[nodiscard]] double total_energy(const HistoryRow& row) const;
  /// The kick that the last step has left to the next (s): half a step in leapfrog.
  [[nodiscard]] double closing_kick() const;
  /// The states with that kick done, and nothing moved: velocities and momentum at the time of the positions.
  [[nodiscard]] std::vector<State> after_closing_kick() const;
  /// The stages of each phase, body by body, then what couples them.
  void run(std::span<const Phase> phases, std::vector<State>& states) const;
  void run_geometry(std::vector<State>& states) const;

  Splitting splitting_;
  std::vector<Material> materials_;
  std::vector<State> states_;
  std::vector<Plan> plans_;
  std::vector<Coupling> couplings_;
  double start_energy_ = 0.0;
  double start_momentum_ = 0.0;
};

}  // namespace hompm
