// A free end of a body as a point on which conditions can be put.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <hompm/effects/registry.hpp>
#include <hompm/plan/plan.hpp>

namespace hompm::detail {

/// +1 at a right end, where +X points outward, −1 at a left one.
inline double outward(Side side) { return side == Side::right ? 1.0 : -1.0; }

/// The `end` of an effect that has `which_end` among its parameters.
Side side_of(const EffectSpec& spec);
EffectParameter which_end(const std::string& standard);

/// Why what holds an end does not go with the scene, "" where it does: its impulse goes to the grid by the
/// velocity of the particles (musl, not APIC), in kicks that go forward in time.
std::string conflict_of_held_end(const EffectSpec& spec, const Scene& scene);

/// A marker on this end carries the stress of its own stretch, not one that is applied: what holds the end
/// answers to it. Without markers nothing.
void join_own_stress(Side side, const StageBuilder& builder);
/// For `EffectType::join_linear`: of what makes an end stand, or move as it says; and of what leaves it to
/// its fellow.
void join_standing_end(Side side, LinearEnd how, const PlanBuilder& builder);
void join_coupled_end(Side side, LinearEnd how, const PlanBuilder& builder);
/// The same as `join_own_stress`, in Phase::end_stress, while a gap (m) is shut and the stress pushes.
void carry_contact_stress(State& state, Field total_stress, Side side, double gap);

/// The velocity (m/s) at which a gap may close: so that it is shut at the end of the drift, and no more.
/// Where no drift follows (outputs), 0 for a gap that is shut, no bound for another.
double approach_limit(const State& state, double gap);

/// When a gap (m) that closes with a velocity (m/s) will be shut, s from now; infinite for one that is shut
/// or opens.
double arrival_of(const State& state, double gap, double closing_velocity);

/// A free end, with what an impulse J on it does. The end is a functional ℓ of particle data: the marker, or
/// the line through the two outer particles, drawn on over half the length of the outer one. It is at ℓ(X +
/// u), and the drift moves it with ℓ(N) v. J changes particle velocities by J N M⁻¹ ℓ(N), M the mass by which
/// the scheme divides forces, the grid velocity by the projection of that, and so the velocity of the end by
/// J w. A condition on the velocity of the end is one scalar equation for J, and the drift meets it.
///
/// J goes the way of all forces, through the particles to the grid, so that with it the step stays symmetric:
/// to hold a velocity is an orthogonal projection that can only lower the highest frequency, and the critical
/// step of the free end holds (with consistent mass, where that is so but nearly, to 1 %: docs/stability.md).
/// An essential condition on the grid is another thing: it takes the functions beyond the end away, and the
/// limit may be lower.
class BodyEnd {
 public:
  BodyEnd(const PlanBuilder& builder, Side side);

  /// Where it is (m), with infinitesimal kinematics too, where displacements are all that moves.
  [[nodiscard]] double position(const State& state) const;
  /// At which it moves after the kick (m/s).
  [[nodiscard]] double velocity(const State& state) const;

  /// What an impulse on the end does.
  struct Response {
    double compliance = 0.0;       ///< w, m²/kg
    double velocity = 0.0;         ///< of the end (m/s), after the kick but without an impulse on it
    double velocity_before = 0.0;  ///< and before the kick
    double reaction = 0.0;         ///< at fixed ends, of a unit impulse

    /// What an impulse does to the kinetic energy (J/m²): J times the mean of the velocities before and after
    /// kick and impulse.
    [[nodiscard]] double work(double impulse) const {
      return impulse * 0.5 * (velocity_before + velocity + compliance * impulse);
    }
  };
  /// In Phase::constraint.
  [[nodiscard]] Response find(State& state) const;
  /// Applies an impulse (kg/(m s), in +X) to the velocities of particles and grid, and books it. Returns its
  /// work.
  double push(State& state, const Response& response, double impulse) const;

  /// What a stage or coupling that finds and pushes does with the fields.
  [[nodiscard]] Fields reads() const;
  [[nodiscard]] Fields changes() const;
  [[nodiscard]] Fields writes() const;
  /// Such a stage.
  [[nodiscard]] Stage stage(std::string name, std::function<void(State&)> run) const;

 private:
  struct Part {
    std::size_t particle = 0;
    double weight = 0.0;
  };
  /// Calls `visit(function, value)` for ℓ(N).
  template <class Visit>
  void for_functions(const State& state, Visit visit) const;

  /// The way of all changes of velocity: `grid` to the particles, whose projection replaces it.
  void send_through_particles(State& state, std::vector<double>& grid, std::vector<double>& particles) const;

  std::shared_ptr<const Discretisation> discretisation_;
  std::array<Part, 2> parts_{};              ///< ℓ
  Field grid_response_, particle_response_;  ///< of velocities, to a unit impulse
  /// By the forces; where the projection reconstructs fields, and the response to impulses is not symmetric.
  Field grid_change_, particle_change_;
};

/// Two ends that face each other: the right one of a body, the left one of the next.
class EndPair {
 public:
  explicit EndPair(const PairBuilder& pair) : a_(pair.left, Side::right), b_(pair.right, Side::left) {}

  /// Between the ends, m.
  [[nodiscard]] double gap(const State& left, const State& right) const {
    return b_.position(right) - a_.position(left);
  }
  /// At which the gap closes, m/s.
  [[nodiscard]] double closing_velocity(const State& left, const State& right) const {
    return a_.velocity(left) - b_.velocity(right);
  }
  /// Takes `change` (m/s) off the closing velocity by an impulse on both, and returns its work (J/m²).
  double slow_down(State& left, State& right, double change) const;
  /// A coupling that does.
  [[nodiscard]] Coupling coupling(std::string name, std::function<void(State&, State&)> run) const;

 private:
  BodyEnd a_, b_;
};

}  // namespace hompm::detail
