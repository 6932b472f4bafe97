// The reference where no closed form is known: Legendre spectral elements in the reference configuration.
#pragma once

#include <hompm/reference/loads.hpp>
#include <hompm/reference/reference.hpp>

namespace hompm {

/// How finely the method of lines divides space and time.
struct Resolution {
  int elements;
  int degree;          ///< of the polynomials within an element
  double step_factor;  ///< time step × fastest wave speed ÷ smallest distance between nodes
};

/// What suits a scene: high degree where the solution is smooth, many elements where loads switched on at t =
/// 0 send kinks through it.
Resolution suitable_resolution(const Scene& scene, const Loads& loads);

/// ρ0 ü = ∂(σ + η ∂v/∂x)/∂X + ρ0 b − β ρ0 v with any law, solved by the Galerkin method on
/// Legendre–Gauss–Lobatto nodes (diagonal mass; Canuto et al. 2006) and the classical Runge–Kutta method
/// (Boost.odeint). The result is a function of time (s, not decreasing) and reference positions (m,
/// ascending, in the body). It throws `Error` when time decreases, and when the material turns inside out or
/// gives way: beyond that time no smooth solution exists. A shock alone does not stop it; it shows in the
/// distance between two resolutions.
FieldsAt method_of_lines(const Scene& scene, const Loads& loads, const Resolution& resolution,
                         const ReferenceWatch& watch = {});

}  // namespace hompm
