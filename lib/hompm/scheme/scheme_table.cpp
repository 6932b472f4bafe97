#include <string>
#include <vector>

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
       .choices = {},
       .look = {"#D55E00", 1, 7}},
      {.name = "bspline",
       .summary = "B-splines, particle quadrature",
       .source = "Steffen, Kirby, Berzins, Int. J. Numer. Methods Engrg. 76 (2008) 922-948",
       .lowest_degree = 1,
       .highest_degree = 5,
       .default_degree = 2,
       .choices = {},
       .look = {"#0072B2", 1, 5}},
      {.name = "ugimp",
       .summary = "hat functions averaged over particle domains that keep their length",
       .source = "Bardenhagen, Kober, Comput. Model. Engrg. Sci. 5 (2004) 477-495",
       .lowest_degree = 1,
       .highest_degree = 1,
       .default_degree = 1,
       .choices = {.basis = Basis::uniform_domains},
       .look = {"#E69F00", 1, 11}},
      {.name = "cpgimp",
       .summary = "hat functions averaged over particle domains that stretch",
       .source = "Bardenhagen, Kober, Comput. Model. Engrg. Sci. 5 (2004) 477-495",
       .lowest_degree = 1,
       .highest_degree = 1,
       .default_degree = 1,
       .choices = {.basis = Basis::contiguous_domains},
       .look = {"#56B4E9", 1, 15}},
      {.name = "cpdi",
       .summary = "functions linear over particle domains whose ends the grid carries",
       .source = "Sadeghirad, Brannon, Burghardt, Int. J. Numer. Methods Engrg. 86 (2011) 1435-1456",
       .lowest_degree = 1,
       .highest_degree = 1,
       .default_degree = 1,
       .choices = {.basis = Basis::carried_domains},
       .look = {"#56B4E9", 2, 14}},
      {.name = "ddmp",
       .summary = "hat functions with smoothed gradients (dual domain)",
       .source = "Zhang, Ma, Giguere, J. Comput. Phys. 230 (2011) 6379-6398",
       .lowest_degree = 1,
       .highest_degree = 1,
       .default_degree = 1,
       .choices = {.basis = Basis::smoothed_gradients},
       .look = {"#882255", 1, 6}},
      {.name = "apic",
       .summary = "B-splines, particles carry velocity and its gradient, update stress last",
       .source = "Jiang, Schroeder, Selle, Teran, Stomakhin, ACM Trans. Graph. 34 (2015) 51",
       .lowest_degree = 1,
       .highest_degree = 5,
       .default_degree = 2,
       .choices = {.sequence = Sequence::usl, .transfer = Transfer::apic},
       .look = {"#332288", 1, 8}},
      {.name = "total-lagrangian",
       .summary = "B-splines on the reference configuration: no particle crosses a cell",
       .source = "de Vaucorbeil, Nguyen, Hutchinson, Comput. Methods Appl. Mech. Engrg. 360 (2020) 112783",
       .lowest_degree = 1,
       .highest_degree = 5,
       .default_degree = 2,
       .choices = {.formulation = Formulation::total_lagrangian, .stress_update = StressUpdate::from_stretch},
       .look = {"#332288", 2, 12}},
      {.name = "tielen2017",
       .summary = "B-splines, cubic-spline reconstruction, Gauss quadrature, consistent velocity",
       .source = "Tielen, Wobbes, Moller, Beuth, Procedia Engineering 175 (2017) 265-272",
       .lowest_degree = 1,
       .highest_degree = 5,
       .default_degree = 2,
       .choices = {.quadrature = Quadrature::reconstructed,
                   .velocity_projection = VelocityProjection::consistent,
                   .free_end = FreeEnd::cut_span},
       .look = {"#009E73", 1, 9}},
      {.name = "mls",
       .summary = "B-splines, moving least squares, Gauss quadrature, consistent velocity",
       .source = "Sulsky, Gong, in Innovative Numerical Approaches for Multi-Field and Multi-Scale Problems, "
                 "Springer (2016) 217-240",
       .lowest_degree = 1,
       .highest_degree = 3,
       .default_degree = 2,
       .choices = {.quadrature = Quadrature::moving_least_squares,
                   .velocity_projection = VelocityProjection::consistent,
                   .free_end = FreeEnd::cut_span},
       .look = {"#882255", 2, 4}},
      {.name = "tls",
       .summary = "B-splines, Taylor least squares that keep the mass of each cell, null-space relaxation",
       .source =
           "Wobbes, Moller, Galavi, Vuik, Int. J. Numer. Methods Engrg. 117 (2019) 271-290; the relaxation: "
           "docs/schemes.md",
       .lowest_degree = 1,
       .highest_degree = 3,
       .default_degree = 2,
       .choices = {.quadrature = Quadrature::taylor_least_squares,
                   .velocity_projection = VelocityProjection::consistent,
                   .stress_update = StressUpdate::from_positions,
                   .free_end = FreeEnd::cut_span,
                   .conserve = Conserve::cell_mass},
       .relaxes = true,
       .look = {"#117733", 2, 10}},
      {.name = "mixed",
       .summary = "hat functions, mean stress of cells inside the body, particle quadrature at its ends",
       .source = "Beuth, PhD thesis, University of Stuttgart (2012); Al-Kafaji, PhD thesis, University of "
                 "Stuttgart (2013)",
       .lowest_degree = 1,
       .highest_degree = 1,
       .default_degree = 1,
       .choices = {.quadrature = Quadrature::mixed},
       .look = {"#E69F00", 2, 2}},
      {.name = "high-order",
       .summary = "consistent acceleration, stretch from positions, boundary markers, extension, leapfrog",
       .source = "docs/method.md, after Tielen et al. 2017 and Yamaguchi, Moriguchi, Terada 2021",
       .lowest_degree = 2,
       .highest_degree = 5,
       .default_degree = 3,
       .choices = {.quadrature = Quadrature::reconstructed_exact,
                   .acceleration_mass = MassForm::consistent,
                   .velocity_projection = VelocityProjection::least_squares,
                   .transfer = Transfer::pic,
                   .stress_update = StressUpdate::from_positions,
                   .time_integrator = TimeIntegrator::leapfrog,
                   .free_end = FreeEnd::extension,
                   .markers = true},
       .relaxes = true,
       .look = {"#CC79A7", 1, 13}},
  };
  return table;
}

const Splitting& splitting(TimeIntegrator integrator) {
  static const Splitting euler_cromer{{1.0}, {1.0}};
  static const Splitting leapfrog{{0.5, 0.5}, {1.0}};
  static const Splitting blanes_moan = [] {
    const double b1 = 0.0829844064174052;
    const double b2 = 0.396309801498368;
    const double b3 = -0.0390563049223486;
    const double a1 = 0.245298957184271;
    const double a2 = 0.604872665711080;
    const double a3 = 0.5 - (a1 + a2);
    return Splitting{{b1, b2, b3, 1.0 - 2.0 * (b1 + b2 + b3), b3, b2, b1}, {a1, a2, a3, a3, a2, a1}};
  }();
  switch (integrator) {
    case TimeIntegrator::euler_cromer: return euler_cromer;
    case TimeIntegrator::leapfrog: return leapfrog;
    default: return blanes_moan;
  }
}

const Scheme& find_scheme(const std::string& name) {
  for (const Scheme& scheme : scheme_table())
    if (scheme.name == name) return scheme;
  throw Error("there is no scheme " + name);
}

}  // namespace hompm
