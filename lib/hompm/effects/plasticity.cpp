#include <cmath>

#include <hompm/effects/effects.hpp>
#include <hompm/plan/plan.hpp>

namespace hompm::detail {
namespace {

/// H of the yield condition |σ − H ε_p| ≤ σ_y with which the tangent while yielding is E_t.
double hardening(const EffectSpec& spec, const Scene& scene) {
  const double E = scene.material.youngs_modulus;
  const double tangent = spec.number("tangent_modulus");
  return E * tangent / (E - tangent);
}

/// Linear kinematic hardening (Prager), by the return map, which is exact for it (Simo, Hughes 1998, section
/// 1.6): σ = E (λ − 1 − ε_p). The law has done the elastic part, by its increment or from the stretch.
void join(const EffectSpec& spec, PlanBuilder& builder) {
  const double E = builder.scene.material.youngs_modulus;
  const double H = hardening(spec, builder.scene);
  const double yield = spec.number("yield_stress");
  const bool increments = builder.scene.scheme.choices.stress_update == StressUpdate::incremental;
  builder.add(
      Phase::motion, "return to the yield stress",
      [=](State& state) {
        Particles& p = state.particles;
        double dissipated = 0.0;
        for (std::size_t i = 0; i < p.size(); ++i) {
          double& plastic = p.plastic_strain[i];
          const double trial = increments ? p.stress[i] : p.stress[i] - E * plastic;
          const double over = std::abs(trial - H * plastic) - yield;
          p.stress[i] = trial;
          if (!(over > 0.0)) continue;
          const double flow = over / (E + H);
          const double signed_flow = trial - H * plastic > 0.0 ? flow : -flow;
          p.stress[i] = trial - E * signed_flow;
          plastic += signed_flow;
          dissipated += p.reference_volume[i] * yield * flow;
        }
        state.balance.dissipated += dissipated;
      },
      "in the state, per particle: plastic strain");
  // E ε²/2 of the law becomes E (ε − ε_p)²/2 + H ε_p²/2.
  builder.plan.stored_energies.push_back([=](const State& state) {
    const Particles& p = state.particles;
    double sum = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i)
      sum += p.reference_volume[i] * p.plastic_strain[i] *
             (0.5 * (E + H) * p.plastic_strain[i] - E * (p.stretch[i] - 1.0));
    return sum;
  });
}

void prepare(const EffectSpec& /*spec*/, const Scene& /*scene*/, State& state) {
  state.particles.plastic_strain.assign(state.particles.size(), 0.0);
}

std::string conflict(const EffectSpec& spec, const Scene& scene) {
  if (scene.material.law != "linear")
    return "it is one of small strain: `material.law` must be \"linear\", not \"" + scene.material.law + '"';
  if (!(spec.number("tangent_modulus") < scene.material.youngs_modulus))
    return "`tangent_modulus` must be below `material.youngs_modulus`";
  if (scene.scheme.choices.sequence == Sequence::usf)
    return "it maps the stress back after the motion: `scheme.sequence` must be \"musl\" or \"usl\"";
  if (scene.initial_displacement &&
      scene.material.youngs_modulus * scene.initial_displacement->steepest(scene.body.length) >
          spec.number("yield_stress"))
    return "it starts elastic: [initial.displacement] must not stress it beyond `yield_stress`";
  int count = 0;
  for (const EffectSpec& other : scene.effects) count += other.type == spec.type ? 1 : 0;
  return count > 1 ? "a material yields in one way: give it once" : "";
}

}  // namespace

EffectType plasticity() {
  return {.name = "plasticity",
          .meaning = "small-strain elastoplasticity with linear kinematic hardening",
          .parameters = {{.name = "yield_stress",
                          .unit = "Pa",
                          .meaning = "at which the undeformed material yields",
                          .minimum = 0.0,
                          .minimum_excluded = true},
                         {.name = "tangent_modulus",
                          .unit = "Pa",
                          .meaning = "d(stress)/d(strain) while it yields, below Young's modulus",
                          .minimum = 0.0}},
          .join = join,
          .conflict = conflict,
          .prepare = prepare};
}

}  // namespace hompm::detail
