#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <hompm/effects/effects.hpp>
#include <hompm/materials/material.hpp>
#include <hompm/numerics/elementary.hpp>

namespace hompm::detail {
namespace {

double frequency(const Scene& scene) {  // over π
  return std::sqrt(scene.material.youngs_modulus / scene.material.density) / scene.body.length;
}

/// The body force b = ü − (∂σ/∂X)/ρ0 of u = G sin(πX/L) sin(πct/L), for any law: with the law linear it
/// vanishes. Given to the particles themselves, so that no quadrature of it enters the error.
class BodyForce {
 public:
  BodyForce(const EffectSpec& spec, const Scene& scene, const State& state)
      : amplitude_(spec.number("amplitude")),
        wave_number_(numerics::pi / scene.body.length),
        density_(scene.material.density),
        frequency_(frequency(scene)) {
    for (const double X : state.particles.reference_position) {
      sine_.push_back(numerics::sin_pi(X / scene.body.length));
      cosine_.push_back(numerics::cos_pi(X / scene.body.length));
    }
  }

  /// Calls `visit(particle, b)` (m/s²) for the force at a time (s).
  template <class Law, class Visit>
  void for_particles(const Law& law, double time, Visit visit) const {
    const double now = amplitude_ * numerics::sin_pi(frequency_ * time);
    const double omega = numerics::pi * frequency_;
    for (std::size_t i = 0; i < sine_.size(); ++i) {
      const double stretch = 1.0 + now * wave_number_ * cosine_[i];
      const double slope = law.tangent(stretch) / density_ * wave_number_ * wave_number_;
      visit(i, now * sine_[i] * (slope - omega * omega));
    }
  }

 private:
  double amplitude_, wave_number_, density_, frequency_;
  std::vector<double> sine_, cosine_;  ///< of πX/L
};

void join(const EffectSpec& spec, const PlanBuilder& builder) {
  const auto force = std::make_shared<const BodyForce>(spec, builder.scene, builder.state);
  std::visit(
      [&](const auto& law) {
        builder.add({.name = "manufactured body force",
                     .phase = Phase::acceleration,
                     .reads = {"particles.mass"_field},
                     .changes = {"particles.velocity"_field, "balance.impulse"_field},
                     .run = [force, law](State& state) {
                       Particles& p = state.particles;
                       force->for_particles(law, state.position_time, [&](std::size_t i, double b) {
                         p.velocity[i] += state.kick * b;
                         state.balance.impulse += state.kick * p.mass[i] * b;
                       });
                     }});
        builder.add({.name = "manufactured body force: external work",
                     .phase = Phase::work,
                     .reads = {"particles.mass"_field, "particles.velocity"_field},
                     .changes = {"balance.external_work"_field},
                     .run = [force, law](State& state) {
                       const Particles& p = state.particles;
                       const double middle = state.position_time + 0.5 * state.drift;
                       force->for_particles(law, middle, [&](std::size_t i, double b) {
                         state.balance.external_work += state.drift * p.mass[i] * b * p.velocity[i];
                       });
                     }});
      },
      make_material(builder.scene.material));
}

/// The velocity of the solution at t = 0.
void prepare(const EffectSpec& spec, const Scene& scene, State& state) {
  const double velocity = spec.number("amplitude") * numerics::pi * frequency(scene);
  Particles& p = state.particles;
  for (std::size_t i = 0; i < p.size(); ++i)
    p.velocity[i] += velocity * numerics::sin_pi(p.reference_position[i] / scene.body.length);
}

std::string conflict(const EffectSpec& spec, const Scene& scene) {
  if (scene.ends.left == End::free || scene.ends.right == End::free)
    return "its solution is at rest at both ends: they must be \"fixed\"";
  if (scene.initial_displacement)
    return "it starts from the undeformed body: leave out [initial.displacement]";
  if (scene.initial_velocity) return "it brings its own velocity at the start: leave out [initial.velocity]";
  if (has_memory(scene.material))
    return "its solution is elastic: `material.law` must not be \"" + scene.material.law + '"';
  const double largest_strain = numerics::pi * std::abs(spec.number("amplitude")) / scene.body.length;
  if (!(largest_strain < 1.0))
    return "its solution turns the body inside out: `amplitude` must be below length/π";
  return "";
}

/// It oscillates for ever, with the energy of its largest strain.
LoadOutlook outlook(const EffectSpec& spec, const Scene& scene) {
  const double strain = numerics::pi * spec.number("amplitude") / scene.body.length;
  return {.settled_from = strain == 0.0 ? 0.0 : std::numeric_limits<double>::infinity(),
          .energy = scene.material.youngs_modulus * strain * strain * scene.body.length};
}

}  // namespace

EffectType manufactured() {
  return {
      .name = "manufactured",
      .meaning = "body force and start for which u = G sin(pi X/L) sin(pi c t/L): for studies of convergence",
      .parameters = {{.name = "amplitude", .unit = "m", .meaning = "G, below length/pi"}},
      .join = join,
      .conflict = conflict,
      .outlook = outlook,
      .prepare = prepare};
}

}  // namespace hompm::detail
