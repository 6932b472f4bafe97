// How a scene is discretised: each scheme is a row of choices, not a solver of its own.
#pragma once

#include <string>
#include <vector>

#include <hompm/scene/scene.hpp>

namespace hompm {

/// Where stress (and consistent mass) are integrated.
enum class Quadrature {
  particles,      ///< at the particles, with their volumes
  reconstructed,  ///< at Gauss points, from cubic splines through the particle data
};
enum class MassForm {
  lumped,      ///< row sums over the particles
  consistent,  ///< the full matrix, from the reconstructed density
};
enum class StressUpdate {
  incremental,  ///< σ += (dσ/dε) dε
  from_positions,  ///< λ = ∂x/∂X of the spline through the positions, σ = σ(λ): nothing is summed up, nothing
                   ///< drifts
};
enum class TimeIntegrator {
  euler_cromer,  ///< first order: kick, drift
  leapfrog,      ///< second order: velocities live at half steps; as many forces as Euler–Cromer
  blanes_moan,   ///< fourth order: six kicks and drifts a step
};
enum class FreeEnd {
  particles,  ///< nothing special: the quadrature is the particles'
  cut_span,   ///< the last span is integrated up to the material boundary, half a particle beyond the last
  extension,  ///< the same up to a boundary marker, and the function on the cut span alone tied to its
              ///< neighbours
};

/// A step of length Δt as kicks (velocity += kick Δt a) and drifts (position += drift Δt v), kick first. One
/// kick more than drifts closes the step; it is merged with the first kick of the next.
struct Splitting {
  std::vector<double> kicks;
  std::vector<double> drifts;
};

/// Leapfrog: Störmer–Verlet. blanes_moan: S. Blanes, P. C. Moan, J. Comput. Appl. Math. 142 (2002) 313–330,
/// the method SRKN of order 4 with 6 stages, in its form b a b.
const Splitting& splitting(TimeIntegrator integrator);

/// The names a scene may give: euler-cromer, leapfrog, blanes-moan.
const std::vector<std::string>& integrator_names();
/// The integrator called `name`; throws `Error` when there is none.
TimeIntegrator find_integrator(const std::string& name);

struct Scheme {
  std::string name;
  std::string summary;
  std::string source;  ///< paper
  int lowest_degree;
  int highest_degree;
  int default_degree;
  Quadrature quadrature;
  MassForm acceleration_mass;
  MassForm velocity_mass;
  StressUpdate stress_update;
  TimeIntegrator integrator;
  FreeEnd free_end;
  bool markers;  ///< massless particles mark the ends of the body
  bool relaxes;  ///< null-space relaxation of velocity and displacement
};

/// The table of schemes, in the order in which `--list` shows them.
const std::vector<Scheme>& scheme_table();

/// The row called `name`; throws `Error` when there is none.
const Scheme& find_scheme(const std::string& name);

/// The row that a scene names, with the choices the scene makes itself. Throws `Error` for a name that is
/// none.
Scheme choose_scheme(const SchemeSpec& spec);

}  // namespace hompm
