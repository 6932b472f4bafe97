// The last part of a step: the grid velocity moves the particles and strains them.
#pragma once

#include <hompm/scheme/particle_transfer.hpp>
#include <hompm/scheme/scheme.hpp>

namespace hompm::detail {

/// u += Δt Σ N_i v_i and dε = Δt Σ dN_i/dx v_i for every particle, then stretch, volume and stress:
/// finite kinematics λ ← λ (1 + dε), V = V0 λ, x = X + u; infinitesimal λ ← λ + dε, nothing moves.
/// Stress by the increment of the law or from the stretch (method: Tielen et al. 2017, section 3;
/// docs/method.md). Throws `InvalidRun` when a stretch is not above zero.
template <int P, Kinematics kinematics, StressUpdate update, class Law>
void move_particles(State& state, const Law& law) {
  Particles& p = state.particles;
  const double dt = state.time_step;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double strain = dt * gather<P>(state, state.basis.gradients, state.fields.velocity, i);
    p.displacement[i] += dt * gather<P>(state, state.basis.values, state.fields.velocity, i);
    if constexpr (update == StressUpdate::incremental)
      p.stress[i] += law.modulus(p.stress[i], p.stretch[i]) * strain;
    if constexpr (kinematics == Kinematics::finite) {
      p.stretch[i] *= 1.0 + strain;
      if (!(p.stretch[i] > 0.0)) throw_inverted(state, i, p.stretch[i]);
      p.position[i] = p.reference_position[i] + p.displacement[i];
      p.volume[i] = p.reference_volume[i] * p.stretch[i];
    } else {
      p.stretch[i] += strain;
    }
    if constexpr (update == StressUpdate::from_stretch) p.stress[i] = law.stress(p.stretch[i]);
  }
}

}  // namespace hompm::detail
