// A plan is the ordered list of stages that a scene and a scheme call for; nothing else is constructed. It
// has no memory: all that changes in a run is in the state.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hompm/plan/fields.hpp>

namespace hompm {

/// The parts of a step, in the order in which they run.
enum class Phase {
  geometry,        ///< what depends on the positions alone: once per run with infinitesimal kinematics
  strain,          ///< update stress first: stretch and stress of the law, by the velocities of the last step
  total_stress,    ///< the stress that makes forces: that of the law, and what effects add
  end_stress,      ///< what is applied at free ends, for schemes with markers there
  internal_force,  ///< sets force = −f_int
  external_force,  ///< effects add to the force
  damping_force,   ///< effects that need the whole out-of-balance force
  acceleration,    ///< grid acceleration, particle velocity
  velocity,        ///< particle velocity to the grid
  transfer,        ///< what particles keep of their own velocity
  constraint,      ///< conditions on the velocity of an end, by the impulse that meets them
  work,            ///< effects book what their forces did
  motion,          ///< displacement, stretch, stress of the law
  count_
};

/// What --explain calls them.
inline constexpr std::array<std::string_view, static_cast<std::size_t>(Phase::count_)> phase_titles{
    "geometry",       "strain",        "total stress", "stress at the ends", "internal force",
    "external force", "damping force", "acceleration", "velocity",           "transfer",
    "constraint",     "work",          "motion"};

inline std::string_view title_of(Phase phase) { return phase_titles[static_cast<std::size_t>(phase)]; }

using Fields = std::vector<Field>;

struct Stage {
  std::string name;
  Phase phase;
  Fields reads = {};    ///< and leaves as they are
  Fields changes = {};  ///< reads and writes, or writes only in part
  Fields writes = {};   ///< whole, whatever was there before
  std::function<void(State&)> run;
  std::string called_by = {};  ///< "scheme tielen2017 (column.toml:23:1)"; from `StageBuilder::add`
};

struct Plan {
  std::array<std::vector<Stage>, static_cast<std::size_t>(Phase::count_)> phases;
  /// The stress (Pa) of which forces are made. That of the law itself, but where an effect or a marker at a
  /// free end adds something.
  Field total_stress = "particles.stress"_field;
  /// Potential energies (J/m²) of the loads that have one.
  std::vector<std::function<double(const State&)>> potentials = {};
  /// Energies (J/m²) that the body stores beside ψ(λ) of the law.
  std::vector<std::function<double(const State&)>> stored_energies = {};

  /// For each gap at an end, when it will be shut at the present velocity, s from now; infinite for one that
  /// is shut or opens.
  std::vector<std::function<double(const State&)>> arrivals = {};

  [[nodiscard]] bool adds_stress() const { return total_stress != "particles.stress"_field; }
  [[nodiscard]] std::vector<Stage>& operator[](Phase phase) {
    return phases[static_cast<std::size_t>(phase)];
  }
  [[nodiscard]] const std::vector<Stage>& operator[](Phase phase) const {
    return phases[static_cast<std::size_t>(phase)];
  }
  void run(Phase phase, State& state) const {
    for (const Stage& stage : (*this)[phase]) stage.run(state);
  }
};

/// How a scheme goes between particles and grid: what effects need of it.
class Discretisation {
 public:
  virtual ~Discretisation() = default;
  /// The projection of particle velocities (or changes of them) to the grid. Returns what fixed ends add to
  /// the momentum, kg/(m s).
  virtual double project(State& state, const std::vector<double>& particles,
                         std::vector<double>& grid) const = 0;
  /// Turns impulses b_i on the grid functions into changes of the grid velocity, M⁻¹ b with the mass by which
  /// the scheme divides forces; fixed ends stay at rest. Returns the sum of the impulses that hold them.
  virtual double divide_by_mass(State& state, std::vector<double>& impulses) const = 0;
  /// Whether a free end with extension ties functions to others.
  [[nodiscard]] virtual bool ties() const = 0;
  /// Moves the forces on functions that are tied to those that carry them, Cᵀ f: a tied function has no force
  /// out of balance of its own, and what acts on it does not vanish at rest.
  virtual void untie(State& state, std::vector<double>& forces) const = 0;
  /// Whether the projection of a step leaves ∫ρ v N_i of the grid velocity in GridFields::momentum.
  [[nodiscard]] virtual bool keeps_momentum() const = 0;
  /// Sets GridFields::momentum to that, where it does not.
  virtual void find_momentum(State& state) const = 0;
  /// Sets one ∂v/∂x (1/s) per particle, of the grid velocity.
  virtual void velocity_gradient(const State& state, std::vector<double>& gradient) const = 0;
  /// What these read beside their arguments and the grid velocity.
  [[nodiscard]] virtual Fields reads() const = 0;
};

/// What a scheme gets when it joins a plan, and all that do.
struct StageBuilder {
  const Scene& scene;
  const SchemeSpec& scheme;  ///< that of the scene, but in the linear step of the critical time step
  State& state;
  Plan& plan;
  std::string called_by;

  /// Declares a field and gives it its size; `initial` is in every entry. A name that is taken already gets a
  /// number.
  [[nodiscard]] Field field(const FieldInfo& info, double initial = 0.0) const;
  template <class T>
  [[nodiscard]] Own<T> own(std::string_view name, std::string_view meaning,
                           std::unique_ptr<T> workspace) const {
    const Field field_of_it = field({name, "", meaning, Site::workspace});
    state.declared.back().workspace = std::move(workspace);
    return {field_of_it};
  }
  void add(Stage stage) const;
  /// Makes the total stress a field of its own, which begins as that of the law; once.
  void add_total_stress() const;
  /// Where the scheme has massless particles at the ends: they carry what is applied there.
  [[nodiscard]] bool has_markers() const { return state.particles.markers > 0; }
};

/// What an effect gets.
struct PlanBuilder : StageBuilder {
  std::shared_ptr<const Discretisation> discretisation;
};

/// What two neighbouring bodies do to each other, in a phase of the step after the stages of both; the fields
/// are those of each.
struct Coupling {
  std::string name;
  Phase phase;
  std::size_t left = 0;  ///< the body on the left; the other is the next one
  std::array<Fields, 2> reads = {}, changes = {}, writes = {};
  std::function<void(State& left, State& right)> run;
  std::string called_by = {};
  std::function<double(const State& left, const State& right)> arrival = {};  ///< as `Plan::arrivals`
};

/// What an effect between two bodies gets when it joins their plans.
struct PairBuilder {
  const PlanBuilder& left;
  const PlanBuilder& right;
  std::size_t index;  ///< of the body on the left
  std::vector<Coupling>& couplings;

  void add(Coupling coupling) const;
};

/// Follows the fields through a step. Throws `Error` where a stage reads what no stage writes, or what one
/// writes only later, or where it overwrites what another has written and nothing has read; both stages are
/// named. `body` is that of the plan, for its couplings.
void check_plan(const Plan& plan, const State& state, std::span<const Coupling> couplings = {},
                std::size_t body = 0);

template <class T>
T& Own<T>::of(State& state) const {
  return static_cast<T&>(*state.declared[field.index - core_fields.size()].workspace);
}

}  // namespace hompm
