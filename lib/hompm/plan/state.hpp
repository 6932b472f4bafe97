// All fields of a run as plain arrays: what the stages of a plan work on; and the fields that effects, laws
// and schemes add, declared once, and workspaces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hompm/numerics/spline_space.hpp>
#include <hompm/scene/scene.hpp>

namespace hompm {

struct State;

/// What the entries of a field belong to.
enum class Site {
  body,               ///< one value for the body
  particle,           ///< one entry per particle, markers included
  particle_function,  ///< `BasisAtParticles::stencil` entries per particle
  function,           ///< one entry per grid function
  workspace,          ///< an object of a class of its own
};

/// All that is to be said of a field. Traces, checkpoints, `--explain` and the columns of result files go by
/// it.
struct FieldInfo {
  std::string_view name;     ///< a word: of a declared field it is the column of result files, too
  std::string_view unit;     ///< SI, "–" for none
  std::string_view meaning;  ///< for --explain
  Site site = Site::particle;
  /// Kept from step to step: it has a value before the first one, and is part of traces and checkpoints. Else
  /// it is scratch, of use within a step once a stage has written it.
  bool persists = false;
  bool reported = false;  ///< a column of particles.csv and point data of a .vtu; for fields of particles
};

/// A field of a plan and the states that go with it; as `"particles.velocity"_field`, or from
/// `StageBuilder::field`.
struct Field {
  std::size_t index = std::numeric_limits<std::size_t>::max();
  bool operator==(const Field&) const = default;
  explicit operator bool() const { return index != Field{}.index; }
};

/// What a scheme computes from the state in one stage for others of the same step, where arrays do not do. It
/// follows from the state, and is copied with it.
class Workspace {
 public:
  virtual ~Workspace() = default;
  [[nodiscard]] virtual std::unique_ptr<Workspace> clone() const = 0;

 protected:
  Workspace() = default;
  Workspace(const Workspace&) = default;
  Workspace& operator=(const Workspace&) = default;
};

/// Its `clone`, by the copy constructor: `class LeastSquares : public Cloned<Workspace, LeastSquares>`.
template <class Base, class Derived>
class Cloned : public Base {
 public:
  [[nodiscard]] std::unique_ptr<Workspace> clone() const override {
    return std::make_unique<Derived>(static_cast<const Derived&>(*this));
  }
};

/// A field that is no member of the state's own, with its values.
struct DeclaredField {
  std::string name;  ///< with the group that goes with its site: "particles.plastic_strain"
  std::string unit, meaning;
  Site site = Site::particle;
  bool persists = false, reported = false;
  std::vector<double> values = {};
  std::unique_ptr<Workspace> workspace = {};

  DeclaredField(std::string full_name, const FieldInfo& info)
      : name(std::move(full_name)),
        unit(info.unit),
        meaning(info.meaning),
        site(info.site),
        persists(info.persists),
        reported(info.reported) {}
  DeclaredField(const DeclaredField& other) : DeclaredField(other.name, other.info()) {
    values = other.values;
    if (other.workspace) workspace = other.workspace->clone();
  }
  DeclaredField(DeclaredField&&) = default;
  DeclaredField& operator=(DeclaredField other) {
    swap(other);
    return *this;
  }
  ~DeclaredField() = default;

  [[nodiscard]] FieldInfo info() const { return {name, unit, meaning, site, persists, reported}; }

 private:
  void swap(DeclaredField& other) noexcept {
    std::swap(name, other.name);
    std::swap(unit, other.unit);
    std::swap(meaning, other.meaning);
    std::swap(site, other.site);
    std::swap(persists, other.persists);
    std::swap(reported, other.reported);
    std::swap(values, other.values);
    std::swap(workspace, other.workspace);
  }
};

/// One entry per particle, ordered by reference position. The displacement is what is summed up, and the
/// position follows from it: small motions far from the origin keep their digits.
///
/// With markers the first and the last entry are massless particles at the ends of the body: they move and
/// strain like the others, so that the material boundary is known, and end the data of the splines. They are
/// not reported.
struct Particles {
  std::size_t markers = 0;                 ///< at each end: 0 or 1
  std::vector<double> reference_position;  ///< X, m
  std::vector<double> displacement;        ///< u, m
  std::vector<double> position;            ///< x = X + u, m (X itself with infinitesimal kinematics)
  std::vector<double> velocity;            ///< m/s
  std::vector<double> mass;                ///< kg/m²
  std::vector<double> reference_density;   ///< ρ0, kg/m³
  std::vector<double> reference_volume;    ///< m
  std::vector<double> volume;              ///< V = V0 λ, m (V0 with infinitesimal kinematics)
  std::vector<double> stretch;             ///< λ
  std::vector<double> stress;              ///< σ of the law, Pa; see Plan::total_stress

  [[nodiscard]] std::size_t size() const { return mass.size(); }  ///< markers included
};

/// Hat functions that a particle sees by its domain, which may touch three cells, or by smoothed gradients.
inline constexpr int domain_stencil = 4;

/// Grid functions at the particles: for each particle the first function that is not zero there, and the
/// values and gradients (1/m) of `stencil` functions from that one on.
struct BasisAtParticles {
  std::size_t stencil = 0;  ///< degree + 1 for splines, else `domain_stencil`
  std::vector<std::int32_t> first;
  std::vector<double> values;
  std::vector<double> gradients;
};

/// One entry per grid function.
struct GridFields {
  std::vector<double> mass;            ///< row sums Σ m_p N_i, kg/m²
  std::vector<double> internal_force;  ///< Pa
  std::vector<double> force;           ///< out of balance: external − internal, Pa
  std::vector<double> acceleration;    ///< m/s²
  std::vector<double> momentum;        ///< ∫ρ v N_i, kg/(m s), see Discretisation::find_momentum
  std::vector<double> velocity;        ///< of the last projection, m/s
};

/// Sums over the steps so far, for the balances.
struct Balance {
  double dissipated = 0.0;     ///< J/m²
  double external_work = 0.0;  ///< J/m²
  double impulse = 0.0;        ///< of all forces on the body, kg/(m s)
};

struct State {
  std::int64_t step = 0;
  double time = 0.0;           ///< s, at the end of the step under way
  double time_rest = 0.0;      ///< s, what rounding left of it
  double position_time = 0.0;  ///< s, of the positions at which its forces act
  double time_step = 0.0;      ///< s, of the step under way; with it goes the kick that it leaves to the next
  double kick = 0.0;           ///< s, by which the part of the step under way changes velocities
  double drift = 0.0;          ///< s, by which it changes positions

  numerics::SplineSpace grid;
  Ends ends;
  bool moves = false;          ///< finite kinematics
  bool basis_moves = false;    ///< the same, but for total Lagrangian formulations: particles cross cells
  double total_mass = 0.0;     ///< kg/m²
  double left_boundary = 0.0;  ///< of the material, m
  double right_boundary = 0.0;
  double left_stress =
      0.0;  ///< applied at the ends, Pa, tension positive; kept only for schemes with markers
  double right_stress = 0.0;

  Particles particles;
  BasisAtParticles basis;
  GridFields fields;
  Balance balance;
  std::vector<DeclaredField> declared = {};  ///< by effects, laws and schemes

  /// The array of a field: a declared one, or a member that holds a `double` for each entry.
  [[nodiscard]] std::vector<double>& operator[](Field field);
  [[nodiscard]] const std::vector<double>& operator[](Field field) const {
    return const_cast<State&>(*this)[field];
  }
  /// The declared field "particles.right_end", say; null where there is none.
  [[nodiscard]] std::vector<double>* find(std::string_view name);
  [[nodiscard]] const std::vector<double>* find(std::string_view name) const {
    return const_cast<State&>(*this).find(name);
  }

  /// Volumes (m) and densities (kg/m³) in the configuration on which the basis lives.
  [[nodiscard]] const std::vector<double>& basis_volumes() const {
    return basis_moves ? particles.volume : particles.reference_volume;
  }
  [[nodiscard]] double basis_density(std::size_t particle) const {
    return basis_moves ? density(particle) : particles.reference_density[particle];
  }

  /// ρ0/λ, kg/m³ (ρ0 with infinitesimal kinematics, where volumes stay).
  [[nodiscard]] double density(std::size_t particle) const {
    return moves ? particles.reference_density[particle] / particles.stretch[particle]
                 : particles.reference_density[particle];
  }
};

/// A workspace of type `T`, as `StageBuilder::own` declared it.
template <class T>
struct Own {
  Field field = {};
  explicit operator bool() const { return static_cast<bool>(field); }
  [[nodiscard]] T& of(State& state) const;
  [[nodiscard]] const T& of(const State& state) const { return of(const_cast<State&>(state)); }
};

/// The undeformed body at rest, with infinitesimal kinematics: what the linear step begins with.
State undeformed_state(const Scene& scene);

/// The state of a scene at t = 0: particles at (2i − 1)/(2k) of each cell with equal volumes, initial
/// velocity, displaced as the scene says and stressed by that; the grid reaches `margin_cells` beyond each
/// free end; markers where the scene's scheme has them. Allocates every array a step needs.
State initial_state(const Scene& scene);

}  // namespace hompm
