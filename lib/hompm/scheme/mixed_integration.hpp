// Mixed integration: Gauss points where cells are full, particles where they are not.
#pragma once

#include <hompm/plan/state.hpp>

namespace hompm::detail {

/// f_i = Σ_cells h σ_c dN_i/dx for the hat functions. In a full cell, one between the ends of the material,
/// σ_c is the mean of the particle stresses there, weighted with the volumes: one Gauss point is exact. In
/// others it is Σ V_p σ_p / h, particle quadrature. (L. Beuth, Formulation and Application of a Quasi-Static
/// Material Point Method, University of Stuttgart 2012; I. K. J. Al-Kafaji, Formulation of a Dynamic Material
/// Point Method, University of Stuttgart 2013.) A cell without particles has no stress.
void mixed_internal_force(State& state, const std::vector<double>& stress);

}  // namespace hompm::detail
