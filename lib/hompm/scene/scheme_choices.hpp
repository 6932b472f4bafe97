// The choices that make a scheme: each may be made on its own, a named scheme is a row of them.
#pragma once

namespace hompm {

/// The functions that carry particle data to the grid and back.
enum class Basis {
  splines,             ///< B-splines of the scheme's degree at the particle; degree 1: hat functions
  uniform_domains,     ///< hat functions averaged over the particle's domain, of the initial length
  contiguous_domains,  ///< the same, the domain stretched as the particle
  carried_domains,     ///< hat functions made linear over a domain whose ends the grid carries along
  smoothed_gradients,  ///< hat functions, their gradients mixed with averages around the nodes
};
/// Where the basis lives.
enum class Formulation {
  updated_lagrangian,  ///< on the present configuration: particles cross cells
  total_lagrangian,    ///< on the reference configuration
};
/// Where stress (and consistent mass) are integrated.
enum class Quadrature {
  particles,      ///< at the particles, with their volumes
  reconstructed,  ///< at the Gauss points of Tielen et al. 2017, from cubic splines through particle data
  reconstructed_exact,   ///< the same, with as many points and splines of such a degree as the basis asks for
  moving_least_squares,  ///< at the same points as `reconstructed`, from moving least squares of particle
                         ///< data
  taylor_least_squares,  ///< at the same points, from a least-squares parabola in each cell (Wobbes et al.
                         ///< 2019)
  mixed,  ///< in cells inside the body the mean of the particles there, in others at the particles (Beuth
          ///< 2012)
};
/// Whether particle data become functions that are integrated at Gauss points.
inline bool reconstructs(Quadrature quadrature) {
  return quadrature != Quadrature::particles && quadrature != Quadrature::mixed;
}
/// What least squares of degree 2 go with: they do not follow functions of a higher degree, and where several
/// fit into a cell no step is stable for long.
inline constexpr int highest_degree_of_parabolas = 3;
enum class MassForm {
  lumped,      ///< row sums over the particles
  consistent,  ///< the full matrix, from the reconstructed density
};
/// Particle velocity to the grid.
enum class VelocityProjection {
  lumped,         ///< Σ m_p v_p N_i over the row sum
  consistent,     ///< of the reconstructed ρ and v, with the consistent mass
  least_squares,  ///< the grid velocity nearest to the particles': Σ m_p (Σ N_i v_i − v_p)² is least
};
/// The parts of a step in their order (Bardenhagen, J. Comput. Phys. 180 (2002) 383–403; MUSL: Sulsky, Zhou,
/// Schreyer, Comput. Phys. Commun. 87 (1995) 236–252).
enum class Sequence {
  musl,  ///< forces, particle velocities, these to the grid, stress: modified update stress last
  usl,   ///< forces, grid velocities, stress: update stress last
  usf,   ///< stress, of the velocities at the start of the step, forces, grid velocities
};
/// By which grid velocity particles move in MUSL; the one after the projection strains them.
enum class PositionUpdate {
  after_projection,   ///< that of the updated particle velocities, as it strains them (Tielen et al. 2017)
  before_projection,  ///< that of the grid's own update (de Vaucorbeil, Nguyen, Sinaie, Wu, Adv. Appl. Mech.
                      ///< 53 (2020) 185–398)
};
/// What essential boundary conditions do to a system with a consistent matrix.
enum class EssentialConditions {
  in_system,       ///< fixed functions are no unknowns
  after_solution,  ///< the system is solved for all functions, fixed ones are set to zero afterwards
};
/// What particles take back from the grid.
enum class Transfer {
  flip,  ///< the change of velocity, or that mixed with the velocity
  pic,   ///< the velocity
  apic,  ///< the velocity and its gradient (Jiang et al. 2015)
  xpic,  ///< the change of velocity, less what a filter finds that the grid does not see
};
enum class StressUpdate {
  incremental,   ///< σ += (dσ/dε) dε
  from_stretch,  ///< λ ← λ (1 + dε), σ = σ(λ)
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
  extension,  ///< the same, and the function on the cut span alone tied to its neighbours
};
/// What the reconstructed density keeps of the particles' masses.
enum class Conserve {
  nothing,        ///< exactly; the masses agree to the order of the midpoint rule
  cell_mass,      ///< ∫ρ over each cell is the sum of the masses there (Wobbes et al. 2019)
  momentum,       ///< row sums of the mass matrix are Σ m_p N_i: forces change Σ m_p v_p by what they are
  cell_momentum,  ///< as cell_mass, and ∫ρv over each cell is the sum of the momenta there
};

/// The defaults are the classical form.
struct SchemeChoices {
  Basis basis = Basis::splines;
  Formulation formulation = Formulation::updated_lagrangian;
  Quadrature quadrature = Quadrature::particles;
  MassForm acceleration_mass = MassForm::lumped;
  VelocityProjection velocity_projection = VelocityProjection::lumped;
  Sequence sequence = Sequence::musl;
  PositionUpdate position_update = PositionUpdate::after_projection;
  Transfer transfer = Transfer::flip;
  double flip_fraction = 1.0;  ///< of the change of velocity; the rest is the velocity itself
  int xpic_order = 2;          ///< m of XPIC(m); 1 is PIC
  StressUpdate stress_update = StressUpdate::incremental;
  TimeIntegrator time_integrator = TimeIntegrator::euler_cromer;
  FreeEnd free_end = FreeEnd::particles;
  bool markers = false;  ///< massless particles mark the ends of the body
  Conserve conserve = Conserve::nothing;
  EssentialConditions essential_conditions = EssentialConditions::in_system;
};

}  // namespace hompm
