// The last part of a step: the grid velocity moves the particles and strains them.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <hompm/materials/material.hpp>
#include <hompm/plan/plan.hpp>
#include <hompm/scheme/least_squares.hpp>
#include <hompm/scheme/particle_domains.hpp>
#include <hompm/scheme/reconstruction.hpp>

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
  Displacing(State& state, const std::vector<double>& velocity)
      : place_(state.particles),
        u_(state.particles.displacement.data()),
        drift_(state.drift),
        velocity_(state, state.basis.values, velocity) {}

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
  const Displacing<P, motion> displace(state, state.fields.velocity);
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
void displace(State& state, const std::vector<double>& velocity) {
  const std::size_t count = state.particles.size();
  const Displacing<P, motion> displace(state, velocity);
  for (std::size_t i = 0; i < count; ++i) displace(i);
}

/// λ = 1 + ∂u/∂X of the spline through (X_p, u_p), and σ(λ): path-independent laws, nothing summed up but
/// positions (docs/method.md). `Splines` is factorised for the reference positions. Throws `InvalidRun` as
/// above.
template <class Splines>
class StretchFromPositions : public Cloned<Workspace, StretchFromPositions<Splines>> {
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
void join_relaxation(const StageBuilder& builder, Own<LeastSquares<P>> least_squares) {
  const Field projected = builder.field({"seen_displacement", "m", "projection of u", Site::function});
  builder.add({.name = "null-space relaxation of the displacement",
               .phase = Phase::motion,
               .reads = {"basis.first"_field, "basis.values"_field, least_squares.field},
               .changes = {"particles.displacement"_field},
               .writes = {projected},
               .run = [=, rate = builder.scheme.relaxation_rate](State& state) {
                 auto& u = state.particles.displacement;
                 least_squares.of(state).project(state, u, state[projected]);
                 const double part = state.drift * rate;
                 const Gather<P> seen(state, state.basis.values, state[projected]);
                 for (std::size_t p = 0; p < u.size(); ++p) u[p] += part * (seen(p) - u[p]);
               }});
}

/// Calls `visit` with the law by which kernels update the stress: of one with memory that of an elastic step.
template <class Visit>
void visit_elastic(const Material& material, Visit visit) {
  std::visit(
      [&]<class Law>(const Law& law) {
        if constexpr (HasMemory<Law>)
          visit(static_cast<const typename Law::Elastic&>(law));
        else
          visit(law);
      },
      material);
}

/// After each update of the stress, of a law with memory: what the law remembers, and what that makes of the
/// stress.
inline void join_memory(Phase phase, const Material& material, const StageBuilder& builder) {
  const auto add = [&]<class Law>(const Law& law) {
    if constexpr (HasMemory<Law>) {
      std::array<Field, Law::internal_fields.size()> fields;
      for (std::size_t k = 0; k < fields.size(); ++k) {
        const auto& [name, unit, meaning] = Law::internal_fields[k];
        fields[k] = builder.field({name, unit, meaning, Site::particle, true, true});
      }
      const auto arrays = [fields](State& state) {
        std::array<double*, Law::internal_fields.size()> values;
        for (std::size_t k = 0; k < values.size(); ++k) values[k] = state[fields[k]].data();
        return values;
      };
      const bool increments = builder.scheme.choices.stress_update == StressUpdate::incremental;
      Stage stage{.name = "memory of the law",
                  .phase = phase,
                  .reads = {"particles.stretch"_field, "particles.reference_volume"_field},
                  .changes = {fields.begin(), fields.end()},
                  .run = [=](State& state) {
                    Particles& p = state.particles;
                    const std::size_t count = p.size();
                    const double* stretch = p.stretch.data();
                    const double* volume = p.reference_volume.data();
                    double* stress = p.stress.data();
                    const auto values = arrays(state);
                    double dissipated = 0.0;
                    for (std::size_t i = 0; i < count; ++i) {
                      typename Law::Internal internal;
                      for (std::size_t k = 0; k < values.size(); ++k) internal[k] = values[k][i];
                      double s = increments ? stress[i] : law.stress(stretch[i], internal);
                      dissipated += volume[i] * law.correct(s, internal);
                      stress[i] = s;
                      for (std::size_t k = 0; k < values.size(); ++k) values[k][i] = internal[k];
                    }
                    state.balance.dissipated += dissipated;
                  }};
      stage.changes.insert(stage.changes.end(), {"particles.stress"_field, "balance.dissipated"_field});
      builder.add(std::move(stage));
      builder.plan.stored_energies.push_back([=](const State& state) {
        const Particles& p = state.particles;
        double sum = 0.0;
        for (std::size_t i = 0; i < p.size(); ++i) {
          typename Law::Internal internal;
          for (std::size_t k = 0; k < fields.size(); ++k) internal[k] = state[fields[k]][i];
          sum += p.reference_volume[i] * law.stored_beside(p.stretch[i], internal);
        }
        return sum;
      });
    }
  };
  std::visit(add, material);
}

template <class Splines, Motion motion>
void join_stretch_from_positions(const Material& material, const StageBuilder& builder) {
  const auto stretch =
      builder.own("spline_of_positions", "spline matrix of the reference positions, its data",
                  std::make_unique<StretchFromPositions<Splines>>(builder.state.particles));
  visit_elastic(material, [&](const auto& law) {
    builder.add(
        {.name = "stretch from positions, stress",
         .phase = Phase::motion,
         .reads = {"particles.displacement"_field},
         .writes = {"particles.position"_field, "particles.volume"_field, "particles.stretch"_field,
                    "particles.stress"_field},
         .run = [law, stretch](State& state) { stretch.of(state).template update<motion>(state, law); }});
  });
  join_memory(Phase::motion, material, builder);
}

/// A stage that strains the particles by the grid velocity, and makes of the strain what the stress update of
/// the scheme asks for: an increment of the stress, or the stress of the stretch, by a stage of its own. Adds
/// `kernel` of the law, or of none.
template <class Kernel>
void join_straining(Phase phase, const std::string& name, const Material& material, Fields changes,
                    const Fields& writes, const StageBuilder& builder, Kernel kernel) {
  const bool from_stretch = builder.scheme.choices.stress_update == StressUpdate::from_stretch;
  changes.push_back("particles.stretch"_field);
  if (!from_stretch) changes.push_back("particles.stress"_field);
  const auto add = [&](const auto& law) {
    builder.add(
        {.name = name,
         .phase = phase,
         .reads = {"basis.first"_field, "basis.values"_field, "basis.gradients"_field, "grid.velocity"_field},
         .changes = changes,
         .writes = writes,
         .run = [law, kernel](State& state) { kernel(state, law); }});
  };
  if (!from_stretch) {
    visit_elastic(material, add);
    return join_memory(phase, material, builder);
  }
  add(NoStress{});
  visit_elastic(material, [&](const auto& law) {
    builder.add({.name = "stress of the stretch",
                 .phase = phase,
                 .reads = {"particles.stretch"_field},
                 .writes = {"particles.stress"_field},
                 .run = [law](State& state) {
                   Particles& p = state.particles;
                   for (std::size_t i = 0; i < p.size(); ++i) p.stress[i] = law.stress(p.stretch[i]);
                 }});
  });
  join_memory(phase, material, builder);
}

/// Stretch and stress by the grid velocity of the particles as they are, before the forces.
template <int P, Motion motion>
void join_stress_first(const Material& material, const StageBuilder& builder,
                       const std::shared_ptr<const Discretisation>& discretisation) {
  Fields reads = discretisation->reads();
  reads.push_back("particles.velocity"_field);
  builder.add({.name = "grid velocity of the particles (USF)",
               .phase = Phase::strain,
               .reads = std::move(reads),
               .writes = {"grid.velocity"_field},
               .run = [discretisation](State& state) {
                 discretisation->project(state, state.particles.velocity, state.fields.velocity);
               }});
  join_straining(Phase::strain, "stretch, stress (USF)", material, {}, {"particles.volume"_field}, builder,
                 [](State& state, const auto& law) { strain_by_increments<P, motion>(state, law); });
}

/// `velocity` of the grid moves the particles, that of the state strains them.
template <int P, Motion motion>
void join_motion(const Material& material, const StageBuilder& builder, Field velocity, Field right_end) {
  const SchemeChoices& choices = builder.scheme.choices;
  const Fields reads{"basis.first"_field, "basis.values"_field, velocity};
  const bool moved_apart = velocity != "grid.velocity"_field;
  if (right_end && motion == Motion::updated)
    builder.add({.name = "ends of the particle domains",
                 .phase = Phase::motion,
                 .reads = {"grid.velocity"_field},
                 .changes = {"left_boundary"_field, right_end},
                 .run = [right_end](State& state) { carry_domains(state, state[right_end]); }});
  if (choices.stress_update == StressUpdate::from_positions) {
    builder.add({.name = "displacement",
                 .phase = Phase::motion,
                 .reads = reads,
                 .changes = {"particles.displacement"_field},
                 .run = [velocity](State& state) {
                   add_at_particles<P>(state, state.drift, state[velocity], state.particles.displacement);
                 }});
    if (choices.quadrature == Quadrature::reconstructed_exact)
      join_stretch_from_positions<MatchingSplines<P>, motion>(material, builder);
    else
      join_stretch_from_positions<numerics::CubicSplineSites, motion>(material, builder);
    return;
  }
  if (choices.sequence == Sequence::usf || moved_apart)
    builder.add({.name = "displacement",
                 .phase = Phase::motion,
                 .reads = reads,
                 .changes = {"particles.displacement"_field},
                 .writes = {"particles.position"_field},
                 .run = [velocity](State& state) { displace<P, motion>(state, state[velocity]); }});
  if (choices.sequence == Sequence::usf) return;
  if (moved_apart)
    join_straining(Phase::motion, "stretch, stress", material, {}, {"particles.volume"_field}, builder,
                   [](State& state, const auto& law) { strain_by_increments<P, motion>(state, law); });
  else
    join_straining(Phase::motion, "displacement, stretch, stress", material, {"particles.displacement"_field},
                   {"particles.position"_field, "particles.volume"_field}, builder,
                   [](State& state, const auto& law) { move_by_increments<P, motion>(state, law); });
}

}  // namespace hompm::detail
