#include <algorithm>
#include <memory>
#include <type_traits>
#include <utility>

#include <hompm/numerics/moving_least_squares.hpp>
#include <hompm/numerics/taylor_least_squares.hpp>
#include <hompm/scheme/data_splines.hpp>
#include <hompm/scheme/join_scheme.hpp>
#include <hompm/scheme/mixed_integration.hpp>
#include <hompm/scheme/motion.hpp>
#include <hompm/scheme/velocity.hpp>

namespace hompm {
namespace {

using detail::Reconstruction;
using detail::scatter;
using Shared = std::shared_ptr<Reconstruction>;

void check_boundaries(const State& state) {
  for (const double boundary : {state.left_boundary, state.right_boundary})
    if (state.grid.locate(boundary).cell < 0) detail::throw_boundary_left_grid(state, boundary);
}

/// With markers these are the ends of the body, without the ends of the outer particles.
void find_boundaries(State& state) {
  const Particles& p = state.particles;
  if (state.ends.left == End::free)
    state.left_boundary = p.position.front() - 0.5 * state.basis_volumes().front();
  if (state.ends.right == End::free)
    state.right_boundary = p.position.back() + 0.5 * state.basis_volumes().back();
  check_boundaries(state);
}

/// The ends of the outer particles' domains, which the grid carries along.
void find_carried_boundaries(State& state) {
  state.right_boundary = state.particles.right_end.back();
  check_boundaries(state);
}

template <int P, int PerHalf, class Sites>
Shared reconstruction_from(Sites sites, const State& state, const SchemeChoices& choices) {
  return std::make_shared<detail::ReconstructionFrom<P, Sites, PerHalf>>(std::move(sites), state, choices);
}

template <int P>
Shared make_reconstruction(const State& state, const SchemeChoices& choices) {
  const std::size_t count = state.particles.size();
  // Tielen et al. (2017) take 2 points in each half of a cell for P = 2.
  constexpr int per_half = std::max(2, P);
  switch (choices.quadrature) {
    case Quadrature::particles:
    case Quadrature::mixed:
      return nullptr;
    case Quadrature::reconstructed:
      return reconstruction_from<P, per_half>(numerics::CubicSplineSites(count), state, choices);
    case Quadrature::reconstructed_exact:
      // Products of two functions are of degree 2P: P + 1 points integrate them.
      return reconstruction_from<P, P + 1>(detail::MatchingSplines<P>(count), state, choices);
    default:
      if constexpr (P <= highest_degree_of_parabolas) {
        if (choices.quadrature == Quadrature::moving_least_squares)
          return reconstruction_from<P, per_half>(numerics::MovingLeastSquares(count), state, choices);
        return reconstruction_from<P, per_half>(numerics::TaylorLeastSquares(count, state.grid), state,
                                                choices);
      } else {
        throw Error("least squares of degree 2 with a basis of degree " + std::to_string(P));
      }
  }
}

template <int P>
void join_geometry(PlanBuilder& builder, const Shared& splines,
                   const std::shared_ptr<detail::LeastSquares<P>>& least_squares) {
  const SchemeChoices& choices = builder.scene.scheme.choices;
  const Ends& ends = builder.scene.ends;
  if (ends.left == End::free || ends.right == End::free)
    builder.add(Phase::geometry, "material boundary at free ends",
                choices.basis == Basis::carried_domains ? find_carried_boundaries : find_boundaries);
  if (choices.basis == Basis::splines)
    builder.add(Phase::geometry, "basis at the particles", detail::evaluate_basis<P>);
  else
    builder.add(Phase::geometry, "basis over the particle domains",
                [basis = choices.basis](State& state) { detail::evaluate_domains(state, basis); });
  const bool row_sums_of_density =
      choices.acceleration_mass == MassForm::consistent && choices.conserve != Conserve::momentum;
  if (!row_sums_of_density || P == 1) builder.add(Phase::geometry, "lumped mass", detail::sum_masses<P>);
  if (choices.basis == Basis::smoothed_gradients)
    builder.add(Phase::geometry, "smoothed gradients", detail::smooth_gradients);
  if (least_squares)
    builder.add(
        Phase::geometry, "least squares on the grid",
        [least_squares](State& state) { least_squares->update(state); }, "per function: band matrix");
  if (!splines) return;
  builder.add(
      Phase::geometry, "data sites and Gauss points",
      [splines](State& state) { splines->update_sites(state); },
      "per particle: site, matrix; per Gauss point: position, weight, basis, data weights");
  if (!detail::needs_density(choices)) return;
  builder.add(
      Phase::geometry, "density and consistent mass",
      [splines](State& state) {
        splines->update_density(state);
        splines->update_consistent_mass(state);
      },
      "per Gauss point: density; per function: band matrix");
  if (row_sums_of_density)
    builder.add(Phase::geometry, "row sums of the mass",
                [splines](State& state) { splines->row_sums(state.fields.mass); });
}

template <int P>
void join_forces(PlanBuilder& builder, const Shared& fields) {
  if (builder.wants_end_stress) {
    builder.add(Phase::end_stress, "no stress at free ends",
                [](State& state) { state.left_stress = state.right_stress = 0.0; });
    builder.add(Phase::internal_force, "markers at free ends carry the applied stress", [](State& state) {
      if (state.ends.left == End::free) state.particles.stress.front() = state.left_stress;
      if (state.ends.right == End::free) state.particles.stress.back() = state.right_stress;
    });
  }
  if (fields) {
    builder.add(
        Phase::internal_force, "internal force from the reconstructed stress",
        [fields](State& state) { fields->internal_force(state); }, "per particle: the stress' coefficients");
  } else if (builder.scene.scheme.choices.quadrature == Quadrature::mixed) {
    builder.add(Phase::internal_force, "internal force from the cells", detail::mixed_internal_force);
  } else {
    builder.add(Phase::internal_force, "internal force from the particles", [](State& state) {
      auto& force = state.fields.internal_force;
      std::fill(force.begin(), force.end(), 0.0);
      const Particles& particles = state.particles;
      scatter<P>(state, state.basis.gradients, force,
                 [volume = state.basis_volumes().data(), stress = particles.stress.data()](std::size_t p) {
                   return volume[p] * stress[p];
                 });
    });
  }
  builder.add(Phase::internal_force, "out-of-balance force", [](State& state) {
    GridFields& g = state.fields;
    for (std::size_t i = 0; i < g.force.size(); ++i) g.force[i] = -g.internal_force[i];
  });
}

/// Each particle reaches P + 1 functions: P is the degree of splines.
template <int P>
void join(const Material& material, PlanBuilder& builder) {
  const SchemeSpec& scheme = builder.scene.scheme;
  const SchemeChoices& choices = scheme.choices;
  builder.wants_end_stress = choices.markers;
  const bool relaxes = scheme.relaxation_rate > 0.0;
  const Shared splines = make_reconstruction<P>(builder.state, choices);
  const auto least_squares = relaxes || choices.velocity_projection == VelocityProjection::least_squares
                                 ? std::make_shared<detail::LeastSquares<P>>(builder.state, choices)
                                 : nullptr;
  const auto affine = choices.transfer == Transfer::apic
                          ? std::make_shared<detail::AffineVelocity<P>>(builder.state, choices)
                          : nullptr;
  const bool total = detail::motion_of(builder.state) == detail::Motion::total;
  builder.velocity_gradient = [total](const State& state, std::vector<double>& gradient) {
    const detail::Gather<P> at(state, state.basis.gradients, state.fields.velocity);
    for (std::size_t p = 0; p < gradient.size(); ++p) gradient[p] = at(p);
    if (!total) return;
    for (std::size_t p = 0; p < gradient.size(); ++p) gradient[p] /= state.particles.stretch[p];
  };
  join_geometry<P>(builder, splines, least_squares);
  detail::join_projection<P>(builder, splines, least_squares, affine);
  const auto with_motion = [&](auto motion) {
    constexpr detail::Motion value = decltype(motion)::value;
    if (choices.sequence == Sequence::usf) detail::join_stress_first<P, value>(material, builder);
    join_forces<P>(builder, splines);
    detail::join_velocity<P>(builder, splines, affine);
    if (relaxes) detail::join_relaxation<P>(builder, least_squares);
    detail::join_motion<P, value>(material, builder);
  };
  switch (detail::motion_of(builder.state)) {
    case detail::Motion::infinitesimal:
      return with_motion(std::integral_constant<detail::Motion, detail::Motion::infinitesimal>{});
    case detail::Motion::updated:
      return with_motion(std::integral_constant<detail::Motion, detail::Motion::updated>{});
    case detail::Motion::total:
      return with_motion(std::integral_constant<detail::Motion, detail::Motion::total>{});
  }
}

}  // namespace

void join_scheme(const Material& material, PlanBuilder& builder) {
  if (builder.scene.scheme.choices.basis != Basis::splines)
    return join<domain_stencil - 1>(material, builder);
  switch (builder.scene.scheme.degree) {
    case 1:
      return join<1>(material, builder);
    case 2:
      return join<2>(material, builder);
    case 3:
      return join<3>(material, builder);
    case 4:
      return join<4>(material, builder);
    default:
      return join<5>(material, builder);
  }
}

}  // namespace hompm
