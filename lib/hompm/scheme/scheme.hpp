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
  incremental,   ///< σ += (dσ/dε) dε
  from_stretch,  ///< σ = σ(λ)
};
enum class TimeIntegrator { euler_cromer };
enum class FreeEnd {
  particles,  ///< nothing special: the quadrature is the particles'
  cut_span,   ///< the last, partly filled span is integrated up to the material boundary
};

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
};

/// The table of schemes, in the order in which `--list` shows them.
const std::vector<Scheme>& scheme_table();

/// The row called `name`; throws `Error` when there is none.
const Scheme& find_scheme(const std::string& name);

}  // namespace hompm
