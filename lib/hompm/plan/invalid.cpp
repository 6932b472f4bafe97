#include <algorithm>
#include <cmath>
#include <cstdint>

#include <hompm/number.hpp>
#include <hompm/plan/invalid.hpp>

namespace hompm::detail {
namespace {

std::string text(double value) { return std::isfinite(value) ? to_text(value) : "not a finite number"; }

[[noreturn]] void invalid(const State& state, std::int64_t particle, const std::string& reason) {
  throw InvalidRun(state.step, state.time, particle, reason);
}

/// The number under which a particle is reported; −1 for a boundary marker.
std::int64_t number(const State& state, std::size_t index) {
  const std::size_t markers = state.particles.markers;
  if (index < markers || index >= state.particles.size() - markers) return -1;
  return static_cast<std::int64_t>(index - markers);
}

}  // namespace

std::string grid_text(const State& state) {
  return "[" + to_text(state.grid.origin()) + ", " + to_text(state.grid.breakpoint(state.grid.cells())) +
         "] m";
}

void throw_left_grid(const State& state, std::size_t particle) {
  invalid(state, number(state, particle),
          "left the grid: its position is " + text(state.particles.position[particle]) + ", the grid is " +
              grid_text(state) +
              "; a step that is too large or too small a grid are the usual causes: " + raise_grid);
}

void throw_boundary_left_grid(const State& state, double boundary) {
  invalid(state, -1,
          "the free end left the grid: it is at " + text(boundary) + ", the grid is " + grid_text(state) +
              "; " + raise_grid);
}

void throw_domain_too_wide(const State& state, std::size_t particle, double width) {
  invalid(state, number(state, particle),
          "its domain of " + text(width) + " m reaches over four cells of " + text(state.grid.cell_width()) +
              " m, three at most; use more particles per cell");
}

void throw_inverted(const State& state, std::size_t particle, double stretch) {
  invalid(state, number(state, particle),
          "inverted: its stretch became " + text(stretch) +
              "; a step that is too large or too few particles per cell are the usual causes");
}

void throw_out_of_order(const State& state, std::size_t particle) {
  invalid(state, number(state, particle),
          "passed its left neighbour: at " + text(state.particles.position[particle]) +
              " m, the neighbour at " + text(state.particles.position[particle - 1]) +
              " m; a step that is too large, or motion that the grid cannot resolve, are the usual causes");
}

void throw_not_finite(const State& state, std::size_t particle, const char* quantity) {
  invalid(state, number(state, particle),
          std::string(quantity) + " is not a finite number; a step that is too large is the usual cause");
}

void throw_negative_density(const State& state, double position, double density) {
  const auto& x = state.particles.position;
  const auto nearest = std::min_element(x.begin(), x.end(), [&](double a, double b) {
    return std::abs(a - position) < std::abs(b - position);
  });
  throw SteepFront(state.step, state.time, number(state, static_cast<std::size_t>(nearest - x.begin())),
                   "the density spline is not positive at x = " + text(position) + " m: " + text(density) +
                       " kg/m^3; the front is too steep for the particles there");
}

void throw_singular_mass(const State& state, std::size_t function) {
  const int degree = state.grid.degree();
  const auto f = static_cast<std::int32_t>(function);
  const auto here = std::count_if(state.basis.first.begin(), state.basis.first.end(),
                                  [&](std::int32_t first) { return first <= f && f <= first + degree; });
  const auto end = [&](int breakpoint) {
    return text(state.grid.breakpoint(std::clamp(breakpoint, 0, state.grid.cells())));
  };
  invalid(state, -1,
          "the consistent mass is singular at grid function " + std::to_string(function) +
              ", x = " + end(f - degree) + " ... " + end(f + 1) + " m: " + std::to_string(here) +
              " particles there do not determine it; raise scheme.particles_per_cell, or lower "
              "scheme.cells or scheme.degree");
}

}  // namespace hompm::detail
