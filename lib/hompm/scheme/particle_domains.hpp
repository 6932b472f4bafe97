// Hat functions seen by particles that fill a domain, or by smoothed gradients: four nodes for each particle.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <hompm/plan/invalid.hpp>

namespace hompm::detail {

struct Domain {
  double left, right;  ///< m
};

/// The domain of a particle, its middle the particle: as long as at the start, or as its volume.
inline Domain around(double position, double length) {
  return {position - 0.5 * length, position + 0.5 * length};
}

/// The domain between the ends that the grid carries along.
inline Domain carried(const State& state, const std::vector<double>& end, std::size_t p) {
  return {p == 0 ? state.left_boundary : end[p - 1], end[p]};
}

/// The hat functions c and c + 1 of a cell at its local coordinate.
struct Hats {
  double left, right;
};
inline Hats hats_at(double s) { return {1.0 - s, s}; }

enum class DomainValues {
  mean,  ///< (1/l) ∫ N_i dx over the domain (Bardenhagen and Kober 2004)
  ends,  ///< ½ N_i(left) + ½ N_i(right) (Sadeghirad, Brannon, Burghardt 2011)
};

/// Values and gradients of the hat functions over a domain: their means, or those of the line through their
/// values at its ends. The gradient is (N_i(right) − N_i(left))/l either way. What of the domain lies outside
/// the grid, beyond a fixed end, is left out. Throws `InvalidRun` where it reaches over four cells, or lies
/// outside the grid.
template <DomainValues kind>
std::int32_t weigh_domain(const State& state, std::size_t p, Domain domain, double* values,
                          double* gradients) {
  const numerics::SplineSpace& grid = state.grid;
  const double left = std::max(domain.left, grid.origin());
  const double right = std::min(domain.right, grid.breakpoint(grid.cells()));
  if (!(left < right)) throw_left_grid(state, p);
  const auto from = grid.locate(left);
  auto to = grid.locate(right);
  if (to.cell < 0) to = {grid.cells() - 1, 1.0};  // the end of the grid, rounded up
  if (to.s == 0.0 && to.cell > from.cell) to = {to.cell - 1, 1.0};
  if (to.cell - from.cell > domain_stencil - 2) throw_domain_too_wide(state, p, right - left);
  const int first = std::min(from.cell, grid.functions() - domain_stencil);
  const double cells = (to.cell - from.cell) + (to.s - from.s);
  std::fill_n(values, domain_stencil, 0.0);
  std::fill_n(gradients, domain_stencil, 0.0);
  for (int cell = from.cell; cell <= to.cell; ++cell) {
    const double begin = cell == from.cell ? from.s : 0.0;
    const double end = cell == to.cell ? to.s : 1.0;
    const double part = (end - begin) / cells;
    const auto k = static_cast<std::size_t>(cell - first);
    if constexpr (kind == DomainValues::mean) {
      const Hats middle = hats_at(0.5 * (begin + end));
      values[k] += part * middle.left;
      values[k + 1] += part * middle.right;
    }
    const double slope = part / grid.cell_width();
    gradients[k] -= slope;
    gradients[k + 1] += slope;
  }
  if constexpr (kind == DomainValues::ends)
    for (const auto& end : {from, to}) {
      const Hats at = hats_at(end.s);
      const auto k = static_cast<std::size_t>(end.cell - first);
      values[k] += 0.5 * at.left;
      values[k + 1] += 0.5 * at.right;
    }
  return first;
}

/// The values of the hat functions at a particle. Throws `InvalidRun` for one outside the grid.
inline std::int32_t hats_of_particle(const State& state, std::size_t p, double* values) {
  const auto at = state.grid.locate(state.particles.position[p]);
  if (at.cell < 0) throw_left_grid(state, p);
  const int first = std::clamp(at.cell - 1, 0, state.grid.functions() - domain_stencil);
  std::fill_n(values, domain_stencil, 0.0);
  const Hats n = hats_at(at.s);
  values[at.cell - first] = n.left;
  values[at.cell + 1 - first] = n.right;
  return first;
}

/// Gradients α N_i′ + (1 − α) Σ_j N_j g_ij of Zhang, Ma, Giguere (2011) for the particles: g_ij = ∫ N_j N_i′
/// dx / ∫ N_j dx, the mean gradient around node j, and α = 2 N_c N_{c+1} in cell c, which vanishes at the
/// nodes, so that the gradient has no jump there. Means are over the cells between nodes that have a
/// velocity: by their mass, or by an essential condition.
inline void smooth_gradients(State& state) {
  const numerics::SplineSpace& grid = state.grid;
  const std::vector<double>& mass = state.fields.mass;
  const double per_width = 1.0 / grid.cell_width();
  const auto has_velocity = [&](int node) {
    if (node < 0 || node > grid.cells()) return false;
    return mass[static_cast<std::size_t>(node)] > 0.0 || (node == 0 && state.ends.left == End::fixed) ||
           (node == grid.cells() && state.ends.right == End::fixed);
  };
  double* gradients = state.basis.gradients.data();
  for (std::size_t p = 0; p < state.particles.size(); ++p, gradients += domain_stencil) {
    const auto at = grid.locate(state.particles.position[p]);
    std::fill_n(gradients, domain_stencil, 0.0);
    const auto index = [first = state.basis.first[p]](int node) {
      return static_cast<std::size_t>(node - first);
    };
    const Hats n = hats_at(at.s);
    const double alpha = 2.0 * n.left * n.right;
    gradients[index(at.cell)] = -alpha * per_width;
    gradients[index(at.cell + 1)] = alpha * per_width;
    for (const auto& [node, share] : {std::pair(at.cell, n.left), std::pair(at.cell + 1, n.right)}) {
      const int left = has_velocity(node - 1) ? node - 1 : node;
      const int right = has_velocity(node + 1) ? node + 1 : node;
      if (left == right) continue;
      const double slope = (1.0 - alpha) * share * per_width / (right - left);
      gradients[index(left)] -= slope;
      gradients[index(right)] += slope;
    }
  }
}

/// Evaluates a basis of four hat functions a particle, but for smoothed gradients; `right_end` is of carried
/// domains. Throws `InvalidRun` for a particle outside the grid.
inline void evaluate_domains(State& state, Basis basis, Field right_end) {
  const Particles& particles = state.particles;
  double* values = state.basis.values.data();
  double* gradients = state.basis.gradients.data();
  const auto for_particles = [&](auto weigh) {
    for (std::size_t p = 0; p < particles.size(); ++p, values += domain_stencil, gradients += domain_stencil)
      state.basis.first[p] = weigh(p);
  };
  const auto mean_around = [&](const std::vector<double>& lengths) {
    for_particles([&](std::size_t p) {
      return weigh_domain<DomainValues::mean>(state, p, around(particles.position[p], lengths[p]), values,
                                              gradients);
    });
  };
  switch (basis) {
    case Basis::uniform_domains: return mean_around(particles.reference_volume);
    case Basis::contiguous_domains: return mean_around(state.basis_volumes());
    case Basis::carried_domains:
      return for_particles([&, &end = state[right_end]](std::size_t p) {
        return weigh_domain<DomainValues::ends>(state, p, carried(state, end, p), values, gradients);
      });
    default: return for_particles([&](std::size_t p) { return hats_of_particle(state, p, values); });
  }
}

/// The ends of the domains move with the grid: x += δ v(x).
inline void carry_domains(State& state, std::vector<double>& right_end) {
  const auto& velocity = state.fields.velocity;
  const auto move = [&](double& x) {
    const auto at = state.grid.locate(x);
    const Hats n = hats_at(at.s);
    const auto cell = static_cast<std::size_t>(at.cell);
    x += state.drift * (n.left * velocity[cell] + n.right * velocity[cell + 1]);
  };
  move(state.left_boundary);
  for (double& end : right_end) move(end);
}

}  // namespace hompm::detail
