#include <hompm/error.hpp>
#include <hompm/scheme/scheme.hpp>

namespace hompm {

const std::vector<Scheme>& scheme_table() {
  static const std::vector<Scheme> table{
      {.name = "classical",
       .summary = "hat functions, particle quadrature",
       .source = "Sulsky, Chen, Schreyer, Comput. Methods Appl. Mech. Engrg. 118 (1994) 179-196",
       .lowest_degree = 1,
       .highest_degree = 1,
       .default_degree = 1,
       .quadrature = Quadrature::particles,
       .acceleration_mass = MassForm::lumped,
       .velocity_mass = MassForm::lumped,
       .stress_update = StressUpdate::incremental,
       .integrator = TimeIntegrator::euler_cromer,
       .free_end = FreeEnd::particles},
      {.name = "bspline",
       .summary = "B-splines, particle quadrature",
       .source = "Steffen, Kirby, Berzins, Int. J. Numer. Methods Engrg. 76 (2008) 922-948",
       .lowest_degree = 1,
       .highest_degree = 5,
       .default_degree = 2,
       .quadrature = Quadrature::particles,
       .acceleration_mass = MassForm::lumped,
       .velocity_mass = MassForm::lumped,
       .stress_update = StressUpdate::incremental,
       .integrator = TimeIntegrator::euler_cromer,
       .free_end = FreeEnd::particles},
      {.name = "tielen2017",
       .summary = "B-splines, cubic-spline reconstruction, Gauss quadrature, consistent velocity",
       .source = "Tielen, Wobbes, Moller, Beuth, Procedia Engineering 175 (2017) 265-272",
       .lowest_degree = 1,
       .highest_degree = 5,
       .default_degree = 2,
       .quadrature = Quadrature::reconstructed,
       .acceleration_mass = MassForm::lumped,
       .velocity_mass = MassForm::consistent,
       .stress_update = StressUpdate::incremental,
       .integrator = TimeIntegrator::euler_cromer,
       .free_end = FreeEnd::cut_span},
  };
  return table;
}

const Scheme& find_scheme(const std::string& name) {
  for (const Scheme& scheme : scheme_table())
    if (scheme.name == name) return scheme;
  throw Error("there is no scheme " + name);
}

}  // namespace hompm
