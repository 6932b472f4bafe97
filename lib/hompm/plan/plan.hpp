// A plan is the ordered list of stages that a scene and a scheme call for; nothing else is constructed.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <hompm/plan/state.hpp>
#include <hompm/scene/scene.hpp>

namespace hompm {

/// The parts of a step, in the order in which they run.
enum class Phase {
  geometry,    ///< what depends on the positions alone: once per run with infinitesimal kinematics
  end_stress,  ///< stresses applied at the ends, for schemes that ask for them, and beside that of the law
  internal_force,  ///< sets force = −f_int
  external_force,  ///< effects add to the force
  damping_force,   ///< effects that need the whole out-of-balance force
  acceleration,    ///< grid acceleration, particle velocity
  velocity,        ///< particle velocity to the grid
  transfer,        ///< what particles keep of their own velocity
  constraint,      ///< conditions on the velocity of an end, by the impulse that meets them
  work,            ///< effects book what their forces did
  motion,          ///< displacement, stretch, stress
  count_
};

struct Stage {
  std::string name;
  std::string arrays;     ///< what the stage owns beyond the state's arrays, for --explain
  std::string called_by;  ///< "scheme tielen2017 (column.toml:23:1)", "effect gravity (column.toml:19:1)"
  std::function<void(State&)> run;
};

struct Plan {
  std::array<std::vector<Stage>, static_cast<std::size_t>(Phase::count_)> phases;
  /// Potential energies (J/m²) of the loads that have one.
  std::vector<std::function<double(const State&)>> potentials;
  /// Energies (J/m²) that the body stores beside ψ(λ) of the law.
  std::vector<std::function<double(const State&)>> stored_energies;
  /// Each adds to one stress (Pa) per particle what acts beside that of the law.
  std::vector<std::function<void(const State&, std::vector<double>&)>> extra_stresses;

  [[nodiscard]] const std::vector<Stage>& operator[](Phase phase) const {
    return phases[static_cast<std::size_t>(phase)];
  }
  void run(Phase phase, State& state) const {
    for (const Stage& stage : (*this)[phase]) stage.run(state);
  }
};

/// What a scheme or an effect gets when it joins a plan.
struct PlanBuilder {
  const Scene& scene;
  const State& state;
  Plan plan = {};
  std::string called_by = {};  ///< set before each effect or choice joins
  /// The scheme asks effects to add what they apply at the ends to State::left_stress and right_stress.
  bool wants_end_stress = false;
  /// Sets GridFields::momentum to ∫ρ v N_i of the grid velocity; empty where the scheme's projection has done
  /// so.
  std::function<void(State&)> update_momentum = {};
  /// Sets one ∂v/∂x (1/s) per particle, of the grid velocity.
  std::function<void(const State&, std::vector<double>&)> velocity_gradient = {};
  /// The stress of the law while effects add to it; of the first effect that does.
  std::shared_ptr<std::vector<double>> law_stress = {};
  /// Turns impulses b_i on the grid functions into changes of the grid velocity, M⁻¹ b with the mass by which
  /// the scheme divides forces; fixed ends stay at rest. Returns the sum of the impulses that hold them.
  std::function<double(const State&, std::vector<double>&)> divide_by_mass = {};
  /// Moves the forces on functions that have no motion of their own to those that carry them along; empty
  /// where all have one.
  std::function<void(std::vector<double>&)> untie = {};
  /// The scheme's projection of particle velocities (or changes of them) to the grid. Returns what fixed ends
  /// add to the momentum, kg/(m s).
  std::function<double(const State&, const std::vector<double>&, std::vector<double>&)> project = {};

  void add(Phase phase, std::string name, std::function<void(State&)> run, std::string arrays = {}) {
    plan.phases[static_cast<std::size_t>(phase)].push_back(
        {std::move(name), std::move(arrays), called_by, std::move(run)});
  }
};

/// What two neighbouring bodies do to each other, in a phase of the step after the stages of both.
struct Coupling {
  Phase phase;
  std::string name;
  std::string called_by;
  std::size_t left;  ///< the body on the left; the other is the next one
  std::function<void(State& left, State& right)> run;
};

/// What an effect between two bodies gets when it joins their plans.
struct PairBuilder {
  PlanBuilder& left;
  PlanBuilder& right;
  std::size_t index;  ///< of the body on the left
  std::vector<Coupling>& couplings;
  std::string called_by;

  void add(Phase phase, std::string name, std::function<void(State&, State&)> run) const {
    couplings.push_back({phase, std::move(name), called_by, index, std::move(run)});
  }
};

}  // namespace hompm
