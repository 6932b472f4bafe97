#include <algorithm>

#include <hompm/scheme/mixed_integration.hpp>

namespace hompm::detail {

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
