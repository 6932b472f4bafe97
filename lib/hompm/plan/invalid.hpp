// How a stage says that the run stopped being valid.
#pragma once

#include <string>

#include <hompm/plan/state.hpp>

namespace hompm::detail {

/// A front too steep for the spline through the densities; what helps depends on the scene.
class SteepFront : public InvalidRun {
 public:
  using InvalidRun::InvalidRun;
};

/// Each throws `InvalidRun` with the step under way, its time, and the particle where there is one.
/// "[−1, 2] m"
std::string grid_text(const State& state);
/// What to do about a grid that is too small, for the end of a message.
inline constexpr const char* raise_grid = "set grid.from and grid.to, or raise scheme.margin_cells";

[[noreturn]] void throw_left_grid(const State& state, std::size_t particle);
[[noreturn]] void throw_boundary_left_grid(const State& state, double boundary);
[[noreturn]] void throw_domain_too_wide(const State& state, std::size_t particle, double width);
[[noreturn]] void throw_inverted(const State& state, std::size_t particle, double stretch);
[[noreturn]] void throw_out_of_order(const State& state, std::size_t particle);
[[noreturn]] void throw_not_finite(const State& state, std::size_t particle, const char* quantity);
[[noreturn]] void throw_negative_density(const State& state, double position, double density);
[[noreturn]] void throw_singular_mass(const State& state, std::size_t function);

}  // namespace hompm::detail
