// The stages of a step for one degree. Each has a file, join_degree_N.cpp: all in one take a minute to
// compile.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <hompm/numerics/moving_least_squares.hpp>
#include <hompm/numerics/taylor_least_squares.hpp>
#include <hompm/scheme/motion.hpp>
#include <hompm/scheme/velocity.hpp>

namespace hompm::detail {

inline void check_boundaries(const State& state) {
  for (const double boundary : {state.left_boundary, state.right_boundary})
    if (state.grid.locate(boundary).cell < 0) throw_boundary_left_grid(state, boundary);
}

/// With markers these are the ends of the body, without the ends of the outer particles.
inline void find_boundaries(State& state) {
  const Particles& p = state.particles;
  if (state.ends.left == End::free)
    state.left_boundary = p.position.front() - 0.5 * state.basis_volumes().front();
  if (state.ends.right == End::free)
    state.right_boundary = p.position.back() + 0.5 * state.basis_volumes().back();
  check_boundaries(state);
}

/// The ends of the outer particles' domains, which the grid carries along.
inline void find_carried_boundaries(State& state, const std::vector<double>& right_end) {
  state.right_boundary = right_end.back();
  check_boundaries(state);
}

/// At t = 0: in the middle between two particles.
inline Field make_right_ends(const StageBuilder& builder) {
  const Scene& scene = builder.scene;
  if (builder.scheme.choices.basis != Basis::carried_domains) return {};
  State& state = builder.state;
  const Particles& p = state.particles;
  const Field right_end = builder.field(
      {.name = "right_end", .unit = "m", .meaning = "of the domain, carried by the grid", .persists = true});
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double X = i + 1 == p.size() ? scene.body.right()
                                       : 0.5 * (p.reference_position[i] + p.reference_position[i + 1]);
    state[right_end][i] = state.basis_moves ? scene.displaced(X) : X;
  }
  return right_end;
}

template <int P, int PerHalf, class Sites>
std::unique_ptr<Reconstruction> reconstruction_from(Sites sites, const State& state,
                                                    const SchemeChoices& choices) {
  return std::make_unique<ReconstructionFrom<P, Sites, PerHalf>>(std::move(sites), state, choices);
}

template <int P>
std::unique_ptr<Reconstruction> make_reconstruction(const State& state, const SchemeChoices& choices) {
  const std::size_t count = state.particles.size();
  // Tielen et al. (2017) take 2 points in each half of a cell for P = 2.
  constexpr int per_half = std::max(2, P);
  switch (choices.quadrature) {
    case Quadrature::particles:
    case Quadrature::mixed: return nullptr;
    case Quadrature::reconstructed:
      return reconstruction_from<P, per_half>(numerics::CubicSplineSites(count), state, choices);
    case Quadrature::reconstructed_exact:
      // Products of two functions are of degree 2P: P + 1 points integrate them.
      return reconstruction_from<P, P + 1>(MatchingSplines<P>(count), state, choices);
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
void join_geometry(const StageBuilder& builder, Own<Reconstruction> splines,
                   Own<LeastSquares<P>> least_squares, Field right_end) {
  const SchemeChoices& choices = builder.scheme.choices;
  const Ends& ends = builder.scene.ends;
  const auto add = [&](std::string name, Fields reads, Fields changes, Fields writes, auto run) {
    builder.add(
        {std::move(name), Phase::geometry, std::move(reads), std::move(changes), std::move(writes), run});
  };
  const Field position = "particles.position"_field, mass = "particles.mass"_field;
  const Fields boundaries{"left_boundary"_field, "right_boundary"_field};
  const Fields basis{"basis.first"_field, "basis.values"_field, "basis.gradients"_field};
  if (ends.left == End::free || ends.right == End::free) {
    if (right_end)
      add("material boundary at free ends", {right_end}, {boundaries[1]}, {},
          [right_end](State& state) { find_carried_boundaries(state, state[right_end]); });
    else
      add("material boundary at free ends", {position, "particles.volume"_field}, boundaries, {},
          find_boundaries);
  }
  if (choices.basis == Basis::splines)
    add("basis at the particles", {position}, {}, basis, evaluate_basis<P>);
  else
    add("basis over the particle domains", {right_end ? right_end : position}, {}, basis,
        [basis = choices.basis, right_end](State& state) { evaluate_domains(state, basis, right_end); });
  const bool row_sums_of_density =
      choices.acceleration_mass == MassForm::consistent && choices.conserve != Conserve::momentum;
  const bool sums_masses = !row_sums_of_density || P == 1;
  if (sums_masses) add("lumped mass", {mass}, basis, {"grid.mass"_field}, sum_masses<P>);
  if (choices.basis == Basis::smoothed_gradients)
    add("smoothed gradients", {position, "grid.mass"_field}, {basis[2]}, {}, smooth_gradients);
  if (least_squares)
    add("least squares on the grid", {basis[0], basis[1]}, {}, {least_squares.field},
        [least_squares](State& state) { least_squares.of(state).update(state); });
  if (!splines) return;
  add("data sites and Gauss points", {position, boundaries[0], boundaries[1]}, {}, {splines.field},
      [splines](State& state) { splines.of(state).update_sites(state); });
  if (!needs_density(choices)) return;
  add("density and consistent mass", {basis[0]}, {splines.field}, {}, [splines](State& state) {
    splines.of(state).update_density(state);
    splines.of(state).update_consistent_mass(state);
  });
  // Beside hat functions the lumped mass has served already, to find functions without any.
  const Fields lumped{"grid.mass"_field};
  if (row_sums_of_density)
    add("row sums of the mass", {splines.field}, sums_masses ? lumped : Fields{},
        sums_masses ? Fields{} : lumped,
        [splines](State& state) { splines.of(state).row_sums(state.fields.mass); });
}

/// Massless particles at free ends carry what is applied there.
inline void join_markers(const StageBuilder& builder) {
  const Ends& ends = builder.scene.ends;
  if (!builder.has_markers() || (ends.left == End::fixed && ends.right == End::fixed)) return;
  builder.add_total_stress();
  const Fields stresses{"left_stress"_field, "right_stress"_field};
  builder.add({.name = "no stress at free ends",
               .phase = Phase::end_stress,
               .writes = stresses,
               .run = [](State& state) { state.left_stress = state.right_stress = 0.0; }});
  builder.add({.name = "markers at free ends carry the applied stress",
               .phase = Phase::internal_force,
               .reads = stresses,
               .changes = {builder.plan.total_stress},
               .run = [total = builder.plan.total_stress](State& state) {
                 if (state.ends.left == End::free) state[total].front() = state.left_stress;
                 if (state.ends.right == End::free) state[total].back() = state.right_stress;
               }});
}

template <int P>
void join_forces(const StageBuilder& builder, Own<Reconstruction> fields) {
  join_markers(builder);
  const Field stress = builder.plan.total_stress;
  Stage stage{.name = "internal force from the particles",
              .phase = Phase::internal_force,
              .reads = {"particles.volume"_field, "basis.first"_field, "basis.gradients"_field, stress},
              .writes = {"grid.internal_force"_field},
              .run = [stress](State& state) {
                auto& force = state.fields.internal_force;
                std::fill(force.begin(), force.end(), 0.0);
                scatter<P>(state, state.basis.gradients, force,
                           [volume = state.basis_volumes().data(),
                            stress = state[stress].data()](std::size_t p) { return volume[p] * stress[p]; });
              }};
  if (fields) {
    stage.name = "internal force from the reconstructed stress";
    stage.reads = {fields.field, stress};
    stage.run = [=](State& state) {
      fields.of(state).internal_force(state[stress], state.fields.internal_force);
    };
  } else if (builder.scheme.choices.quadrature == Quadrature::mixed) {
    stage.name = "internal force from the cells";
    stage.run = [stress](State& state) { mixed_internal_force(state, state[stress]); };
  }
  builder.add(std::move(stage));
  builder.add({.name = "out-of-balance force",
               .phase = Phase::internal_force,
               .reads = {"grid.internal_force"_field},
               .writes = {"grid.force"_field},
               .run = [](State& state) {
                 GridFields& g = state.fields;
                 for (std::size_t i = 0; i < g.force.size(); ++i) g.force[i] = -g.internal_force[i];
               }});
}

/// Each particle reaches P + 1 functions: P is the degree of splines.
template <int P>
std::shared_ptr<const Discretisation> join_degree(const Material& material, const StageBuilder& builder) {
  const SchemeChoices& choices = builder.scheme.choices;
  const bool relaxes = builder.scheme.relaxation_rate > 0.0;
  Own<Reconstruction> splines;
  if (auto made = make_reconstruction<P>(builder.state, choices))
    splines = builder.own("reconstruction", "functions through particle data, Gauss points, consistent mass",
                          std::move(made));
  Own<LeastSquares<P>> least_squares;
  if (relaxes || choices.velocity_projection == VelocityProjection::least_squares)
    least_squares = builder.own("least_squares", "band matrix of the nearest field on the grid",
                                std::make_unique<LeastSquares<P>>(builder.state, choices));
  const auto affine =
      choices.transfer == Transfer::apic ? std::make_shared<const AffineVelocity<P>>(builder) : nullptr;
  const Field right_end = make_right_ends(builder);
  const auto discretisation = std::make_shared<const Discretised<P>>(builder, splines, least_squares, affine);
  join_geometry<P>(builder, splines, least_squares, right_end);
  const auto with_motion = [&](auto motion) {
    constexpr Motion value = decltype(motion)::value;
    if (choices.sequence == Sequence::usf) join_stress_first<P, value>(material, builder, discretisation);
    join_forces<P>(builder, splines);
    const Field moving = join_velocity<P>(builder, splines, affine, discretisation);
    if (relaxes) join_relaxation<P>(builder, least_squares);
    join_motion<P, value>(material, builder, moving, right_end);
  };
  switch (motion_of(builder.state)) {
    case Motion::infinitesimal: with_motion(std::integral_constant<Motion, Motion::infinitesimal>{}); break;
    case Motion::updated: with_motion(std::integral_constant<Motion, Motion::updated>{}); break;
    case Motion::total: with_motion(std::integral_constant<Motion, Motion::total>{});
  }
  return discretisation;
}

}  // namespace hompm::detail
