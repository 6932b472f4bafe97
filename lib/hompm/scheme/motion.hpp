// The last part of a step: the grid velocity moves the particles and strains them.
#pragma once

#include <memory>

#include <hompm/materials/material.hpp>
#include <hompm/plan/plan.hpp>
#include <hompm/scheme/data_splines.hpp>
#include <hompm/scheme/least_squares.hpp>
#include <hompm/scheme/particle_domains.hpp>
#include <hompm/scheme/particle_transfer.hpp>

namespace hompm::detail {

/// What a motion changes.
enum class Motion {
  infinitesimal,  ///< nothing moves
  updated,        ///< gradients are ∂/∂x
  total,          ///< gradients are ∂/∂X: ∂v/∂x = (∂v/∂X)/λ
};

inline Motion motion_of(const State& state) {
  if (!state.moves) return Motion::infinitesimal;
  return state.basis_moves ? Motion::updated : Motion::total;
}

/// x = X + u and V = V0 λ with finite kinematics; nothing moves with infinitesimal ones.
template <Motion motion>
class Placement {
 public:
  explicit Placement(Particles& p)
      : reference_position_(p.reference_position.data()),
        reference_volume_(p.reference_volume.data()),
        position_(p.position.data()),
        volume_(p.volume.data()) {}

  void place(std::size_t i, double displacement) const {
    if constexpr (motion != Motion::infinitesimal) position_[i] = reference_position_[i] + displacement;
  }
  void stretch(std::size_t i, double stretch) const {
    if constexpr (motion != Motion::infinitesimal) volume_[i] = reference_volume_[i] * stretch;
  }

 private:
  const double* reference_position_;
  const double* reference_volume_;
  double* position_;
  double* volume_;
};

/// For a stress that follows from the stretch, later.
struct NoStress {
  [[nodiscard]] static double modulus(double /*stress*/, double /*stretch*/) { return 0.0; }
};

/// dε = Δt Σ dN_i/dx v_i of one particle after the other, then the stress by the increment of the law, and
/// with finite kinematics λ ← λ (1 + dε), V = V0 λ, with infinitesimal λ ← λ + dε (Tielen et al. 2017,
/// section 3; docs/method.md). Throws `InvalidRun` when a stretch is not above zero.
template <int P, Motion motion, class Law>
class Straining {
 public:
  Straining(State& state, const Law& law)
      : state_(state),
        law_(law),
        place_(state.particles),
        stretch_(state.particles.stretch.data()),
        stress_(state.particles.stress.data()),
        drift_(state.drift),
        velocity_gradient_(state, state.basis.gradients, state.fields.velocity) {}

  void operator()(std::size_t i) const {
    const double before = stretch_[i];
    double strain = drift_ * velocity_gradient_(i);
    if constexpr (motion == Motion::total) strain /= before;
    stress_[i] += law_.modulus(stress_[i], before) * strain;
    if constexpr (motion == Motion::infinitesimal) {
      stretch_[i] = before + strain;
    } else {
      const double after = before * (1.0 + strain);
      stretch_[i] = after;
      if (!(after > 0.0)) throw_inverted(state_, i, after);
      place_.stretch(i, after);
    }
  }

 private:
  const State& state_;
  const Law& law_;
  Placement<motion> place_;
  double* stretch_;
  double* stress_;
  double drift_;
  Gather<P> velocity_gradient_;
};

/// u += Δt Σ N_i v_i and x = X + u of one particle after the other.
template <int P, Motion motion>
class Displacing {
 public:
  explicit Displacing(State& state)
      : place_(state.particles),
        u_(state.particles.displacement.data()),
        drift_(state.drift),
        velocity_(state, state.basis.values, state.fields.velocity) {}

  void operator()(std::size_t i) const {
    u_[i] += drift_ * velocity_(i);
    place_.place(i, u_[i]);
  }

 private:
  Placement<motion> place_;
  double* u_;
  double drift_;
  Gather<P> velocity_;
};

template <int P, Motion motion, class Law>
void move_by_increments(State& state, const Law& law) {
  const std::size_t count = state.particles.size();
  const Displacing<P, motion> displace(state);
  const Straining<P, motion, Law> strain(state, law);
  for (std::size_t i = 0; i < count; ++i) {
    displace(i);
    strain(i);
  }
}

template <int P, Motion motion, class Law>
void strain_by_increments(State& state, const Law& law) {
  const std::size_t count = state.particles.size();
  const Straining<P, motion, Law> strain(state, law);
  for (std::size_t i = 0; i < count; ++i) strain(i);
}

template <int P, Motion motion>
void displace(State& state) {
  const std::size_t count = state.particles.size();
  const Displacing<P, motion> displace(state);
  for (std::size_t i = 0; i < count; ++i) displace(i);
}

/// λ = 1 + ∂u/∂X of the spline through (X_p, u_p), and σ(λ): path-independent laws, nothing summed up but
/// positions (docs/method.md). `Splines` is factorised for the reference positions. Throws `InvalidRun` as
/// above.
template <class Splines>
class StretchFromPositions {
 public:
  explicit StretchFromPositions(const Particles& particles)
      : splines_(particles.size()), fit_(particles.size()) {
    if (splines_.factorise(particles.reference_position) != 0)
      throw Error("reference positions are not in ascending order");
  }

  template <Motion motion, class Law>
  void update(State& state, const Law& law) {
    Particles& p = state.particles;
    splines_.fit(p.displacement, fit_);
    splines_.slopes(fit_, p.stretch);
    const std::size_t count = p.size();
    const double* u = p.displacement.data();
    double* stretch = p.stretch.data();
    double* stress = p.stress.data();
    const Placement<motion> place(p);
    for (std::size_t i = 0; i < count; ++i) {
      const double after = 1.0 + stretch[i];
      stretch[i] = after;
      if (motion != Motion::infinitesimal && !(after > 0.0)) throw_inverted(state, i, after);
      place.place(i, u[i]);
      place.stretch(i, after);
      stress[i] = law.stress(after);
    }
  }

 private:
  Splines splines_;
  typename Splines::Fit fit_;
};

/// u_p += Δt/τ (Σ N_i û_i − u_p), û the nearest field on the grid: what of the displacement the grid cannot
/// see decays with the rate 1/τ of the scene.
template <int P>
void join_relaxation(PlanBuilder& builder, const std::shared_ptr<LeastSquares<P>>& least_squares) {
  const auto projected = std::make_shared<std::vector<double>>(builder.state.fields.mass.size());
  builder.add(
      Phase::motion, "null-space relaxation of the displacement",
      [rate = builder.scene.scheme.relaxation_rate, least_squares, projected](State& state) {
        auto& u = state.particles.displacement;
        least_squares->project(state, u, *projected);
        const double part = state.drift * rate;
        const Gather<P> seen(state, state.basis.values, *projected);
        for (std::size_t p = 0; p < u.size(); ++p) u[p] += part * (seen(p) - u[p]);
      },
      "per function: projected displacement");
}

template <class Splines, Motion motion>
void join_stretch_from_positions(const Material& material, PlanBuilder& builder) {
  const auto stretch = std::make_shared<StretchFromPositions<Splines>>(builder.state.particles);
  std::visit(
      [&](const auto& law) {
        builder.add(
            Phase::motion, "stretch from positions, stress",
            [law, stretch](State& state) { stretch->template update<motion>(state, law); },
            "per particle: spline matrix of the reference positions");
      },
      material);
}

inline void join_stress_from_stretch(Phase phase, const Material& material, PlanBuilder& builder) {
  std::visit(
      [&](const auto& law) {
        builder.add(phase, "stress of the stretch", [law](State& state) {
          Particles& p = state.particles;
          for (std::size_t i = 0; i < p.size(); ++i) p.stress[i] = law.stress(p.stretch[i]);
        });
      },
      material);
}

/// Calls `visit` with the law by which the stress grows in the motion.
template <class Visit>
void visit_increments(const SchemeChoices& choices, const Material& material, Visit visit) {
  if (choices.stress_update == StressUpdate::from_stretch)
    visit(NoStress{});
  else
    std::visit(visit, material);
}

/// Stretch and stress by the grid velocity of the particles as they are, before the forces.
template <int P, Motion motion>
void join_stress_first(const Material& material, PlanBuilder& builder) {
  const SchemeChoices& choices = builder.scene.scheme.choices;
  builder.add(Phase::end_stress, "grid velocity of the particles (USF)",
              [project = builder.project](State& state) {
                project(state, state.particles.velocity, state.fields.velocity);
              });
  visit_increments(choices, material, [&](const auto& law) {
    builder.add(Phase::end_stress, "stretch, stress (USF)",
                [law](State& state) { strain_by_increments<P, motion>(state, law); });
  });
  if (choices.stress_update == StressUpdate::from_stretch)
    join_stress_from_stretch(Phase::end_stress, material, builder);
}

template <int P, Motion motion>
void join_motion(const Material& material, PlanBuilder& builder) {
  const SchemeChoices& choices = builder.scene.scheme.choices;
  if (choices.basis == Basis::carried_domains && motion == Motion::updated)
    builder.add(Phase::motion, "ends of the particle domains", carry_domains);
  if (choices.sequence == Sequence::usf) {
    builder.add(Phase::motion, "displacement", displace<P, motion>);
    return;
  }
  if (choices.stress_update != StressUpdate::from_positions) {
    visit_increments(choices, material, [&](const auto& law) {
      builder.add(Phase::motion, "displacement, stretch, stress",
                  [law](State& state) { move_by_increments<P, motion>(state, law); });
    });
    if (choices.stress_update == StressUpdate::from_stretch)
      join_stress_from_stretch(Phase::motion, material, builder);
    return;
  }
  builder.add(Phase::motion, "displacement", [](State& state) {
    add_at_particles<P>(state, state.drift, state.fields.velocity, state.particles.displacement);
  });
  if (choices.quadrature == Quadrature::reconstructed_exact)
    join_stretch_from_positions<MatchingSplines<P>, motion>(material, builder);
  else
    join_stretch_from_positions<numerics::CubicSplineSites, motion>(material, builder);
}

}  // namespace hompm::detail
