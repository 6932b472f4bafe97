#include <algorithm>
#include <cmath>
#include <memory>
#include <type_traits>

#include <hompm/numerics/cubic_spline.hpp>
#include <hompm/numerics/elementary.hpp>
#include <hompm/numerics/interpolating_spline.hpp>
#include <hompm/scheme/join_scheme.hpp>
#include <hompm/scheme/motion.hpp>
#include <hompm/scheme/reconstruction.hpp>

namespace hompm {
namespace {

using detail::gather;
using detail::Reconstruction;
using detail::scatter;
using Shared = std::shared_ptr<Reconstruction>;

/// The splines through the particle data of high-order: a cubic carries them up to P = 3.
template <int P>
using DataSplines =
    std::conditional_t<(P > 3), numerics::InterpolatingSplineSites<5>, numerics::CubicSplineSites>;

/// With markers these are the ends of the body, without the ends of the outer particles.
void find_boundaries(State& state) {
  const Particles& p = state.particles;
  if (state.ends.left == End::free) state.left_boundary = p.position.front() - 0.5 * p.volume.front();
  if (state.ends.right == End::free) state.right_boundary = p.position.back() + 0.5 * p.volume.back();
  for (const double boundary : {state.left_boundary, state.right_boundary})
    if (state.grid.locate(boundary).cell < 0) detail::throw_boundary_left_grid(state, boundary);
}

/// a_i = f_i / M_i; functions with no mass are inactive, and at a fixed end the reaction balances the force.
void accelerate_lumped(State& state) {
  GridFields& g = state.fields;
  for (std::size_t i = 0; i < g.mass.size(); ++i)
    g.acceleration[i] = g.mass[i] > 0.0 ? g.force[i] / g.mass[i] : 0.0;
  const auto fix = [&](std::size_t i) {
    g.acceleration[i] = 0.0;
    state.balance.impulse -= state.kick * g.force[i];
  };
  if (state.ends.left == End::fixed) fix(0);
  if (state.ends.right == End::fixed) fix(g.mass.size() - 1);
}

/// q_p += Δt/τ (Σ N_i q̂_i − q_p): what of the particle data projects to nothing on the grid decays.
template <int P>
void relax(const State& state, double rate, const std::vector<double>& projected, std::vector<double>& data) {
  const double part = state.drift * rate;
  for (std::size_t p = 0; p < data.size(); ++p)
    data[p] += part * (gather<P>(state, state.basis.values, projected, p) - data[p]);
}

template <int P>
Shared make_reconstruction(const Scheme& scheme, const State& state) {
  using numerics::CubicSplineSites;
  const bool extended = scheme.free_end == FreeEnd::extension;
  // Tielen et al. (2017) take 2 points in each half of a cell for P = 2.
  if (!extended)
    return std::make_shared<detail::SplineReconstruction<P, CubicSplineSites, std::max(2, P)>>(state, false);
  // Products of two functions are of degree 2P: P + 1 points integrate them, and a cubic carries data up to P
  // = 3.
  return std::make_shared<detail::SplineReconstruction<P, DataSplines<P>, P + 1>>(state, true);
}

template <int P>
void join_geometry(const Scheme& scheme, PlanBuilder& builder, const Shared& splines) {
  const Ends& ends = builder.scene.ends;
  if (ends.left == End::free || ends.right == End::free)
    builder.add(Phase::geometry, "material boundary at free ends", find_boundaries);
  builder.add(Phase::geometry, "basis at the particles", detail::evaluate_basis<P>);
  if (scheme.acceleration_mass == MassForm::lumped)
    builder.add(Phase::geometry, "lumped mass", [](State& state) {
      std::fill(state.fields.mass.begin(), state.fields.mass.end(), 0.0);
      scatter<P>(state, state.basis.values, state.fields.mass,
                 [&](std::size_t p) { return state.particles.mass[p]; });
    });
  if (!splines) return;
  builder.add(
      Phase::geometry, "spline sites and Gauss points",
      [splines](State& state) { splines->update_sites(state); },
      "per particle: spline matrix; per Gauss point: position, weight, basis, data weights");
  builder.add(
      Phase::geometry, "density and consistent mass",
      [splines](State& state) {
        splines->update_density(state);
        splines->update_consistent_mass(state);
      },
      "per Gauss point: density; per function: band matrix");
  if (scheme.acceleration_mass == MassForm::consistent)
    builder.add(Phase::geometry, "row sums of the mass",
                [splines](State& state) { splines->row_sums(state.fields.mass); });
}

template <int P>
void join_forces(PlanBuilder& builder, const Shared& splines) {
  if (builder.wants_end_stress) {
    builder.add(Phase::end_stress, "no stress at free ends",
                [](State& state) { state.left_stress = state.right_stress = 0.0; });
    builder.add(Phase::internal_force, "markers at free ends carry the applied stress", [](State& state) {
      if (state.ends.left == End::free) state.particles.stress.front() = state.left_stress;
      if (state.ends.right == End::free) state.particles.stress.back() = state.right_stress;
    });
  }
  if (splines) {
    builder.add(
        Phase::internal_force, "internal force from the stress spline",
        [splines](State& state) { splines->internal_force(state); },
        "per particle: the spline's coefficients");
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
void join_velocity(const Scheme& scheme, PlanBuilder& builder, const Shared& splines) {
  if (scheme.acceleration_mass == MassForm::lumped) {
    builder.add(Phase::acceleration, "grid acceleration, lumped mass", accelerate_lumped);
  } else {
    builder.add(Phase::acceleration, "grid acceleration, consistent mass", [splines](State& state) {
      state.fields.acceleration = state.fields.force;
      state.balance.impulse += state.kick * splines->solve(state.fields.acceleration);
    });
  }
  builder.add(Phase::acceleration, "particle velocity (FLIP)", [](State& state) {
    Particles& particles = state.particles;
    for (std::size_t p = 0; p < particles.size(); ++p)
      particles.velocity[p] +=
          state.kick * gather<P>(state, state.basis.values, state.fields.acceleration, p);
  });
  if (scheme.velocity_mass == MassForm::consistent) {
    builder.add(Phase::velocity, "grid velocity, consistent mass", [splines](State& state) {
      GridFields& g = state.fields;
      splines->weighted_integrals(state.particles.velocity, g.momentum);
      g.velocity = g.momentum;
      splines->solve(g.velocity);
    });
  } else {
    builder.add(Phase::velocity, "grid velocity, lumped mass", [](State& state) {
      GridFields& g = state.fields;
      std::fill(g.momentum.begin(), g.momentum.end(), 0.0);
      const Particles& particles = state.particles;
      scatter<P>(state, state.basis.values, g.momentum,
                 [&](std::size_t p) { return particles.mass[p] * particles.velocity[p]; });
      for (std::size_t i = 0; i < g.velocity.size(); ++i)
        g.velocity[i] = g.mass[i] > 0.0 ? g.momentum[i] / g.mass[i] : 0.0;
      if (state.ends.left == End::fixed) g.velocity.front() = 0.0;
      if (state.ends.right == End::fixed) g.velocity.back() = 0.0;
    });
  }
}

template <int P>
void join_relaxation(double rate, PlanBuilder& builder, const Shared& splines) {
  builder.add(Phase::work, "null-space relaxation of the velocity", [rate](State& state) {
    const auto kinetic = [&] {
      double sum = 0.0;
      const Particles& particles = state.particles;
      for (std::size_t p = 0; p < particles.size(); ++p)
        sum += 0.5 * particles.mass[p] * particles.velocity[p] * particles.velocity[p];
      return sum;
    };
    const double before = kinetic();
    relax<P>(state, rate, state.fields.velocity, state.particles.velocity);
    state.balance.dissipated += before - kinetic();
  });
  const auto projected = std::make_shared<std::vector<double>>(builder.state.fields.mass.size());
  builder.add(
      Phase::motion, "null-space relaxation of the displacement",
      [rate, splines, projected](State& state) {
        splines->weighted_integrals(state.particles.displacement, *projected);
        splines->solve(*projected);
        relax<P>(state, rate, *projected, state.particles.displacement);
      },
      "per function: projected displacement");
}

template <int P, Kinematics kinematics>
void join_motion(const Scheme& scheme, const Material& material, PlanBuilder& builder) {
  if (scheme.stress_update == StressUpdate::incremental) {
    std::visit(
        [&](const auto& law) {
          builder.add(Phase::motion, "displacement, stretch, stress",
                      [law](State& state) { detail::move_by_increments<P, kinematics>(state, law); });
        },
        material);
    return;
  }
  builder.add(Phase::motion, "displacement", [](State& state) {
    Particles& particles = state.particles;
    for (std::size_t p = 0; p < particles.size(); ++p)
      particles.displacement[p] +=
          state.drift * gather<P>(state, state.basis.values, state.fields.velocity, p);
  });
  const auto stretch =
      std::make_shared<detail::StretchFromPositions<DataSplines<P>>>(builder.state.particles);
  std::visit(
      [&](const auto& law) {
        builder.add(
            Phase::motion, "stretch from positions, stress",
            [law, stretch](State& state) { stretch->template update<kinematics>(state, law); },
            "per particle: spline matrix of the reference positions");
      },
      material);
}

/// By default the first angular frequency between fixed ends: the result hardly depends on it.
double relaxation_rate(const Scene& scene) {
  const double wave_speed = std::sqrt(scene.material.youngs_modulus / scene.material.density);
  return scene.scheme.relaxation_rate.value_or(numerics::pi * wave_speed / scene.body.length);
}

template <int P>
void join(const Scheme& scheme, const Material& material, PlanBuilder& builder) {
  builder.wants_end_stress = scheme.markers;
  const Shared splines = scheme.quadrature == Quadrature::reconstructed
                             ? make_reconstruction<P>(scheme, builder.state)
                             : nullptr;
  join_geometry<P>(scheme, builder, splines);
  join_forces<P>(builder, splines);
  join_velocity<P>(scheme, builder, splines);
  if (scheme.relaxes && relaxation_rate(builder.scene) > 0.0)
    join_relaxation<P>(relaxation_rate(builder.scene), builder, splines);
  if (builder.scene.kinematics == Kinematics::finite)
    join_motion<P, Kinematics::finite>(scheme, material, builder);
  else
    join_motion<P, Kinematics::infinitesimal>(scheme, material, builder);
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
