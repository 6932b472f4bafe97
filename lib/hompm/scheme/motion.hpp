// The last part of a step: the grid velocity moves the particles and strains them.
#pragma once

#include <hompm/scheme/particle_transfer.hpp>
#include <hompm/scheme/scheme.hpp>

namespace hompm::detail {

/// u += Δt Σ N_i v_i and dε = Δt Σ dN_i/dx v_i for every particle, then the stress by the increment of the
/// law, and with finite kinematics λ ← λ (1 + dε), V = V0 λ, x = X + u, with infinitesimal λ ← λ + dε (Tielen
/// et al. 2017, section 3; docs/method.md). Throws `InvalidRun` when a stretch is not above zero.
template <int P, Kinematics kinematics, class Law>
void move_by_increments(State& state, const Law& law) {
  Particles& p = state.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double strain = state.drift * gather<P>(state, state.basis.gradients, state.fields.velocity, i);
    p.displacement[i] += state.drift * gather<P>(state, state.basis.values, state.fields.velocity, i);
    p.stress[i] += law.modulus(p.stress[i], p.stretch[i]) * strain;
    if constexpr (kinematics == Kinematics::finite) {
      p.stretch[i] *= 1.0 + strain;
      if (!(p.stretch[i] > 0.0)) throw_inverted(state, i, p.stretch[i]);
      p.position[i] = p.reference_position[i] + p.displacement[i];
      p.volume[i] = p.reference_volume[i] * p.stretch[i];
    } else {
      p.stretch[i] += strain;
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
    for (std::size_t i = 0; i < p.size(); ++i) {
      p.stretch[i] = 1.0 + splines_.slope(i, fit_);
      if constexpr (kinematics == Kinematics::finite) {
        if (!(p.stretch[i] > 0.0)) throw_inverted(state, i, p.stretch[i]);
        p.position[i] = p.reference_position[i] + p.displacement[i];
        p.volume[i] = p.reference_volume[i] * p.stretch[i];
      }
      p.stress[i] = law.stress(p.stretch[i]);
    }
  }

 private:
  Splines splines_;
  typename Splines::Fit fit_;
};

}  // namespace hompm::detail
