#include <memory>

#include <hompm/scheme/join_scheme.hpp>
#include <hompm/scheme/motion.hpp>
#include <hompm/scheme/reconstruction.hpp>

namespace hompm {
namespace {

using detail::gather;
using detail::Reconstruction;
using detail::scatter;

void find_boundaries(State& state) {
  const Particles& p = state.particles;
  if (state.ends.left == End::free) state.left_boundary = p.position.front() - 0.5 * p.volume.front();
  if (state.ends.right == End::free) state.right_boundary = p.position.back() + 0.5 * p.volume.back();
  for (const double boundary : {state.left_boundary, state.right_boundary})
    if (state.grid.locate(boundary).cell < 0) detail::throw_boundary_left_grid(state, boundary);
}

/// a_i = f_i / M_i; functions with no mass are inactive, and at a fixed end the reaction balances the force.
void accelerate_grid(State& state) {
  GridFields& g = state.fields;
  for (std::size_t i = 0; i < g.mass.size(); ++i)
    g.acceleration[i] = g.mass[i] > 0.0 ? g.force[i] / g.mass[i] : 0.0;
  const auto fix = [&](std::size_t i) {
    g.acceleration[i] = 0.0;
    state.balance.impulse -= state.time_step * g.force[i];
  };
  if (state.ends.left == End::fixed) fix(0);
  if (state.ends.right == End::fixed) fix(g.mass.size() - 1);
}

template <int P>
void join_geometry(const Scheme& scheme, PlanBuilder& builder,
                   const std::shared_ptr<Reconstruction<P>>& splines) {
  const Ends& ends = builder.scene.ends;
  if (ends.left == End::free || ends.right == End::free)
    builder.add(Phase::geometry, "material boundary at free ends", find_boundaries);
  builder.add(Phase::geometry, "basis at the particles", detail::evaluate_basis<P>);
  builder.add(Phase::geometry, "lumped mass", [](State& state) {
    std::fill(state.fields.mass.begin(), state.fields.mass.end(), 0.0);
    scatter<P>(state, state.basis.values, state.fields.mass,
               [&](std::size_t p) { return state.particles.mass[p]; });
  });
  if (scheme.quadrature == Quadrature::reconstructed)
    builder.add(
        Phase::geometry, "spline sites and Gauss points",
        [splines](State& state) { splines->update_sites(state); },
        "per particle: spline matrix; per Gauss point: position, weight, basis, data weights");
  if (scheme.velocity_mass == MassForm::consistent)
    builder.add(
        Phase::geometry, "density and consistent mass",
        [splines](State& state) {
          splines->update_density(state);
          splines->update_consistent_mass(state);
        },
        "per Gauss point: density; per function: band matrix");
}

template <int P>
void join_forces(const Scheme& scheme, PlanBuilder& builder,
                 const std::shared_ptr<Reconstruction<P>>& splines) {
  if (scheme.quadrature == Quadrature::reconstructed) {
    builder.add(
        Phase::internal_force, "internal force from the stress spline",
        [splines](State& state) { splines->internal_force(state); }, "per particle: second derivatives");
  } else {
    builder.add(Phase::internal_force, "internal force from the particles", [](State& state) {
      auto& force = state.fields.internal_force;
      std::fill(force.begin(), force.end(), 0.0);
      const Particles& particles = state.particles;
      scatter<P>(state, state.basis.gradients, force,
                 [&](std::size_t p) { return particles.volume[p] * particles.stress[p]; });
    });
  }
  builder.add(Phase::internal_force, "out-of-balance force", [](State& state) {
    GridFields& g = state.fields;
    for (std::size_t i = 0; i < g.force.size(); ++i) g.force[i] = -g.internal_force[i];
  });
}

template <int P>
void join_velocity(const Scheme& scheme, PlanBuilder& builder,
                   const std::shared_ptr<Reconstruction<P>>& splines) {
  builder.add(Phase::acceleration, "grid acceleration, lumped mass", accelerate_grid);
  builder.add(Phase::acceleration, "particle velocity (FLIP)", [](State& state) {
    Particles& particles = state.particles;
    for (std::size_t p = 0; p < particles.size(); ++p)
      particles.velocity[p] +=
          state.time_step * gather<P>(state, state.basis.values, state.fields.acceleration, p);
  });
  if (scheme.velocity_mass == MassForm::consistent) {
    builder.add(Phase::velocity, "grid velocity, consistent mass",
                [splines](State& state) { splines->project_velocity(state); });
  } else {
    builder.add(Phase::velocity, "grid velocity, lumped mass", [](State& state) {
      GridFields& g = state.fields;
      std::fill(g.velocity.begin(), g.velocity.end(), 0.0);
      const Particles& particles = state.particles;
      scatter<P>(state, state.basis.values, g.velocity,
                 [&](std::size_t p) { return particles.mass[p] * particles.velocity[p]; });
      for (std::size_t i = 0; i < g.velocity.size(); ++i)
        g.velocity[i] = g.mass[i] > 0.0 ? g.velocity[i] / g.mass[i] : 0.0;
      if (state.ends.left == End::fixed) g.velocity.front() = 0.0;
      if (state.ends.right == End::fixed) g.velocity.back() = 0.0;
    });
  }
}

template <int P, Kinematics kinematics, StressUpdate update>
void join_motion(const Material& material, PlanBuilder& builder) {
  std::visit(
      [&](const auto& law) {
        builder.add(Phase::motion, "displacement, stretch, stress",
                    [law](State& state) { detail::move_particles<P, kinematics, update>(state, law); });
      },
      material);
}

template <int P>
void join(const Scheme& scheme, const Material& material, PlanBuilder& builder) {
  const bool reconstructs =
      scheme.quadrature == Quadrature::reconstructed || scheme.velocity_mass == MassForm::consistent;
  const auto splines = reconstructs ? std::make_shared<Reconstruction<P>>(builder.state) : nullptr;
  join_geometry<P>(scheme, builder, splines);
  join_forces<P>(scheme, builder, splines);
  join_velocity<P>(scheme, builder, splines);
  const bool moves = builder.scene.kinematics == Kinematics::finite;
  const bool increments = scheme.stress_update == StressUpdate::incremental;
  if (moves && increments) join_motion<P, Kinematics::finite, StressUpdate::incremental>(material, builder);
  if (moves && !increments) join_motion<P, Kinematics::finite, StressUpdate::from_stretch>(material, builder);
  if (!moves && increments)
    join_motion<P, Kinematics::infinitesimal, StressUpdate::incremental>(material, builder);
  if (!moves && !increments)
    join_motion<P, Kinematics::infinitesimal, StressUpdate::from_stretch>(material, builder);
}

}  // namespace

void join_scheme(const Scheme& scheme, const Material& material, PlanBuilder& builder) {
  switch (builder.scene.scheme.degree) {
    case 1:
      return join<1>(scheme, material, builder);
    case 2:
      return join<2>(scheme, material, builder);
    case 3:
      return join<3>(scheme, material, builder);
    case 4:
      return join<4>(scheme, material, builder);
    default:
      return join<5>(scheme, material, builder);
  }
}

}  // namespace hompm
