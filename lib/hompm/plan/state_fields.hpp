// The fields of the state, once: what traces and checkpoints know of it.
#pragma once

#include <span>
#include <string_view>

#include <hompm/plan/state.hpp>

namespace hompm {

/// What the entries of a field belong to.
enum class Site {
  run,                ///< one value for the whole run
  particle,           ///< one entry per particle, markers included
  particle_function,  ///< `BasisAtParticles::stencil` entries per particle
  function,           ///< one entry per grid function
};

/// Calls `visit(std::string_view name, Site site, std::span values)` for every field that changes in a run,
/// always in the same order. `values` holds `double`, `std::int32_t` or `std::int64_t`, const where the state
/// is. Left out is what nothing called for, and what follows from the scene alone: grid, ends, kinematics,
/// number of markers.
template <class AnyState, class Visit>
void visit_fields(AnyState& state, Visit visit) {
  // Every member is named, so that a new one does not compile before it has its place here.
  auto& [step, time, position_time, time_step, kick, drift, grid, ends, moves, basis_moves, total_mass,
         left_boundary, right_boundary, left_stress, right_stress, particles, basis, fields, balance] = state;
  auto& [markers, reference_position, displacement, position, velocity, mass, reference_density,
         reference_volume, volume, stretch, stress, plastic_strain, right_end, velocity_gradient] = particles;
  auto& [stencil, first, values, gradients] = basis;
  auto& [grid_mass, internal_force, force, acceleration, momentum, grid_velocity] = fields;
  auto& [dissipated, external_work, impulse] = balance;

  visit("step", Site::run, std::span(&step, 1));
  visit("time", Site::run, std::span(&time, 1));
  visit("position_time", Site::run, std::span(&position_time, 1));
  visit("time_step", Site::run, std::span(&time_step, 1));
  visit("kick", Site::run, std::span(&kick, 1));
  visit("drift", Site::run, std::span(&drift, 1));
  visit("total_mass", Site::run, std::span(&total_mass, 1));
  visit("left_boundary", Site::run, std::span(&left_boundary, 1));
  visit("right_boundary", Site::run, std::span(&right_boundary, 1));
  visit("left_stress", Site::run, std::span(&left_stress, 1));
  visit("right_stress", Site::run, std::span(&right_stress, 1));
  visit("particles.reference_position", Site::particle, std::span(reference_position));
  visit("particles.displacement", Site::particle, std::span(displacement));
  visit("particles.position", Site::particle, std::span(position));
  visit("particles.velocity", Site::particle, std::span(velocity));
  visit("particles.mass", Site::particle, std::span(mass));
  visit("particles.reference_density", Site::particle, std::span(reference_density));
  visit("particles.reference_volume", Site::particle, std::span(reference_volume));
  visit("particles.volume", Site::particle, std::span(volume));
  visit("particles.stretch", Site::particle, std::span(stretch));
  visit("particles.stress", Site::particle, std::span(stress));
  if (!plastic_strain.empty()) visit("particles.plastic_strain", Site::particle, std::span(plastic_strain));
  if (!right_end.empty()) visit("particles.right_end", Site::particle, std::span(right_end));
  if (!velocity_gradient.empty())
    visit("particles.velocity_gradient", Site::particle, std::span(velocity_gradient));
  visit("basis.first", Site::particle, std::span(first));
  visit("basis.values", Site::particle_function, std::span(values));
  visit("basis.gradients", Site::particle_function, std::span(gradients));
  visit("grid.mass", Site::function, std::span(grid_mass));
  visit("grid.internal_force", Site::function, std::span(internal_force));
  visit("grid.force", Site::function, std::span(force));
  visit("grid.acceleration", Site::function, std::span(acceleration));
  visit("grid.momentum", Site::function, std::span(momentum));
  visit("grid.velocity", Site::function, std::span(grid_velocity));
  visit("balance.dissipated", Site::run, std::span(&dissipated, 1));
  visit("balance.external_work", Site::run, std::span(&external_work, 1));
  visit("balance.impulse", Site::run, std::span(&impulse, 1));
}

}  // namespace hompm
