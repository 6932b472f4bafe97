#include <cmath>
#include <vector>

#include <hompm/scheme/particle_transfer.hpp>

namespace hompm::detail {

numerics::SplineSpace::Location locate_outside(const State& state, std::size_t particle) {
  const numerics::SplineSpace& grid = state.grid;
  const double hair = 1e-10 * grid.cell_width();
  const double x = state.particles.position[particle];
  if (std::abs(x - grid.origin()) < hair) return {0, 0.0};
  if (std::abs(x - grid.breakpoint(grid.cells())) < hair) return {grid.cells() - 1, 1.0};
  throw_left_grid(state, particle);
}

void leave_cell_without_mass(State& state, std::size_t next) {
  BasisAtParticles& basis = state.basis;
  const std::vector<double>& mass = state.fields.mass;
  const std::int32_t cell = basis.first[next - 1];
  // Particles of the next cell come later, and touch the function between.
  if (next < basis.first.size() && basis.first[next] == cell + 1) return;
  if (cell + 1 == state.grid.cells() && state.ends.right == End::fixed) return;
  const bool behind = cell > 0 && (mass[static_cast<std::size_t>(cell) - 1] > 0.0 ||
                                   (cell == 1 && state.ends.left == End::fixed));
  for (std::size_t p = next; p-- > 0 && basis.first[p] == cell;) {
    double* values = &basis.values[2 * p];
    if (values[1] > 0.0) continue;  // a marker off the knot, which has no mass
    double* gradients = &basis.gradients[2 * p];
    if (behind) {
      basis.first[p] = cell - 1;
      state.grid.evaluate<1>({cell - 1, 1.0}, values, gradients);
    } else {
      gradients[0] = gradients[1] = 0.0;
    }
  }
}

void mixed_internal_force(State& state, const std::vector<double>& stress) {
  const Particles& p = state.particles;
  const std::vector<double>& volumes = state.basis_volumes();
  const std::int32_t* first = state.basis.first.data();
  const double inverse_width = 1.0 / state.grid.cell_width();
  const auto is_full = [&](int cell) {
    const bool from = state.ends.left == End::fixed || state.left_boundary <= state.grid.breakpoint(cell);
    const bool to = state.ends.right == End::fixed || state.grid.breakpoint(cell + 1) <= state.right_boundary;
    return from && to;
  };
  std::vector<double>& force = state.fields.internal_force;
  std::fill(force.begin(), force.end(), 0.0);
  for (std::size_t i = 0; i < p.size();) {
    const std::int32_t cell = first[i];
    double volume = 0.0, sum = 0.0;
    for (; i < p.size() && first[i] == cell; ++i) {
      volume += volumes[i];
      sum += volumes[i] * stress[i];
    }
    // A marker alone in a cell has no volume.
    const double mean = is_full(cell) && volume > 0.0 ? sum / volume : sum * inverse_width;
    const auto left = static_cast<std::size_t>(cell);
    force[left] -= mean;
    force[left + 1] += mean;
  }
}

}  // namespace hompm::detail
