// How a scene is discretised: each scheme is a row of choices, not a solver of its own.
#pragma once

#include <string>
#include <vector>

#include <hompm/scene/scheme_choices.hpp>

namespace hompm {

/// A step of length Δt as kicks (velocity += kick Δt a) and drifts (position += drift Δt v), kick first. One
/// kick more than drifts closes the step; it is merged with the first kick of the next.
struct Splitting {
  std::vector<double> kicks;
  std::vector<double> drifts;
};

/// Leapfrog: Störmer–Verlet. blanes_moan: S. Blanes, P. C. Moan, J. Comput. Appl. Math. 142 (2002) 313–330,
/// the method SRKN of order 4 with 6 stages, in its form b a b.
const Splitting& splitting(TimeIntegrator integrator);

/// How pictures draw a scheme, everywhere the same.
struct SchemeLook {
  std::string colour;  ///< "#0072B2"
  int dash;            ///< of its lines, as gnuplot counts
  int shape;           ///< of its dots, as gnuplot counts
};

struct Scheme {
  std::string name;
  std::string summary;
  std::string source;  ///< paper
  int lowest_degree;
  int highest_degree;
  int default_degree;
  SchemeChoices choices;  ///< where a row is silent, those of `classical`
  bool relaxes = false;   ///< null-space relaxation unless the scene sets its rate to 0
  SchemeLook look;
};

/// The table of schemes, in the order in which `--list` shows them.
const std::vector<Scheme>& scheme_table();

/// The row called `name`; throws `Error` when there is none.
const Scheme& find_scheme(const std::string& name);

}  // namespace hompm
