// The last part of a step: the grid velocity moves the particles and strains them.
#pragma once

#include <memory>

#include <hompm/materials/material.hpp>
#include <hompm/plan/plan.hpp>
#include <hompm/scheme/data_splines.hpp>
#include <hompm/scheme/least_squares.hpp>
#include <hompm/scheme/particle_transfer.hpp>

namespace hompm::detail {

/// x = X + u and V = V0 λ with finite kinematics; nothing moves with infinitesimal ones.
template <Kinematics kinematics>
class Placement {
 public:
  explicit Placement(Particles& p)
      : reference_position_(p.reference_position.data()),
        reference_volume_(p.reference_volume.data()),
        position_(p.position.data()),
        volume_(p.volume.data()) {}

  void operator()(std::size_t i, double displacement, double stretch) const {
    if constexpr (kinematics == Kinematics::finite) {
      position_[i] = reference_position_[i] + displacement;
      volume_[i] = reference_volume_[i] * stretch;
    }
  }

 private:
  const double* reference_position_;
  const double* reference_volume_;
  double* position_;
  double* volume_;
};

/// u += Δt Σ N_i v_i and dε = Δt Σ dN_i/dx v_i for every particle, then the stress by the increment of the
/// law, and with finite kinematics λ ← λ (1 + dε), V = V0 λ, x = X + u, with infinitesimal λ ← λ + dε (Tielen
/// et al. 2017, section 3; docs/method.md). Throws `InvalidRun` when a stretch is not above zero.
template <int P, Kinematics kinematics, class Law>
void move_by_increments(State& state, const Law& law) {
  Particles& p = state.particles;
  const std::size_t count = p.size();
  double* u = p.displacement.data();
  double* stretch = p.stretch.data();
  double* stress = p.stress.data();
  const Placement<kinematics> place(p);
  const double drift = state.drift;
  const Gather<P> velocity(state, state.basis.values, state.fields.velocity);
  const Gather<P> velocity_gradient(state, state.basis.gradients, state.fields.velocity);
  for (std::size_t i = 0; i < count; ++i) {
    const double strain = drift * velocity_gradient(i);
    const double moved = u[i] + drift * velocity(i);
    const double before = stretch[i];
    u[i] = moved;
    stress[i] += law.modulus(stress[i], before) * strain;
    if constexpr (kinematics == Kinematics::finite) {
      const double after = before * (1.0 + strain);
      stretch[i] = after;
      if (!(after > 0.0)) throw_inverted(state, i, after);
      place(i, moved, after);
    } else {
      stretch[i] = before + strain;
    }
  }
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

  template <Kinematics kinematics, class Law>
  void update(State& state, const Law& law) {
    Particles& p = state.particles;
    splines_.fit(p.displacement, fit_);
    splines_.slopes(fit_, p.stretch);
    const std::size_t count = p.size();
    const double* u = p.displacement.data();
    double* stretch = p.stretch.data();
    double* stress = p.stress.data();
    const Placement<kinematics> place(p);
    for (std::size_t i = 0; i < count; ++i) {
      const double after = 1.0 + stretch[i];
      stretch[i] = after;
      if (kinematics == Kinematics::finite && !(after > 0.0)) throw_inverted(state, i, after);
      place(i, u[i], after);
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

template <class Splines, Kinematics kinematics>
void join_stretch_from_positions(const Material& material, PlanBuilder& builder) {
  const auto stretch = std::make_shared<StretchFromPositions<Splines>>(builder.state.particles);
  std::visit(
      [&](const auto& law) {
        builder.add(
            Phase::motion, "stretch from positions, stress",
            [law, stretch](State& state) { stretch->template update<kinematics>(state, law); },
            "per particle: spline matrix of the reference positions");
      },
      material);
}

template <int P, Kinematics kinematics>
void join_motion(const Material& material, PlanBuilder& builder) {
  const SchemeChoices& choices = builder.scene.scheme.choices;
  if (choices.stress_update == StressUpdate::incremental) {
    std::visit(
        [&](const auto& law) {
          builder.add(Phase::motion, "displacement, stretch, stress",
                      [law](State& state) { move_by_increments<P, kinematics>(state, law); });
        },
        material);
    return;
  }
  builder.add(Phase::motion, "displacement", [](State& state) {
    add_at_particles<P>(state, state.drift, state.fields.velocity, state.particles.displacement);
  });
  if (choices.quadrature == Quadrature::reconstructed_exact)
    join_stretch_from_positions<MatchingSplines<P>, kinematics>(material, builder);
  else
    join_stretch_from_positions<numerics::CubicSplineSites, kinematics>(material, builder);
}

}  // namespace hompm::detail
