#include <algorithm>

#include <hompm/materials/material.hpp>
#include <hompm/number.hpp>

namespace hompm {

double Hencky::stretch(double stress) const {
  constexpr double e = 2.718281828459045;
  const double ratio = stress / youngs_modulus;
  if (!(ratio <= 1.0 / e))
    throw Error("the law hencky reaches at most the stress E/e = " + to_text(youngs_modulus / e) + " Pa");
  // Newton on g(λ) = ln λ − (σ/E) λ from 1/(1 − σ/E), where g ≤ 0 since ln λ ≤ λ − 1. As g is concave, the
  // iterates rise to the root; they have arrived when rounding stops the rise.
  double stretch = 1.0 / (1.0 - ratio);
  for (;;) {
    const double rise = (numerics::log(stretch) - ratio * stretch) / (ratio - 1.0 / stretch);
    const double next = std::min(stretch + rise, e);
    if (!(next > stretch)) return stretch;
    stretch = next;
  }
}

double NeoHookean::stretch(double stress) const {
  // The positive root of λ² − 2τλ − 1 = 0; the two forms are equal, and each is free of cancellation on its
  // side.
  const double ratio = stress / youngs_modulus;
  const double root = std::sqrt(ratio * ratio + 1.0);
  return ratio < 0.0 ? 1.0 / (root - ratio) : root + ratio;
}

namespace {

/// Of the simple laws, which have nothing but E.
template <class Law>
Material simple(const MaterialSpec& spec) {
  return Law{spec.youngs_modulus};
}

Material elastoplastic(const MaterialSpec& spec) {
  const double E = spec.youngs_modulus, tangent = spec.number("tangent_modulus");
  return Elastoplastic{{E}, spec.number("yield_stress"), E * tangent / (E - tangent)};
}

std::string conflict_of_elastoplastic(const Scene& scene) {
  const MaterialSpec& spec = scene.material;
  if (!(spec.number("tangent_modulus") < spec.youngs_modulus))
    return "`material.tangent_modulus` must be below `material.youngs_modulus`";
  if (scene.scheme.choices.time_integrator == TimeIntegrator::blanes_moan)
    return "it cannot take back what has flowed, as the drifts backwards in time of blanes-moan would: "
           "`scheme.time_integrator` must be \"euler-cromer\" or \"leapfrog\"";
  if (scene.initial_displacement &&
      spec.youngs_modulus * scene.initial_displacement->steepest(scene.body.length) >
          spec.number("yield_stress"))
    return "it starts elastic: [initial.displacement] must not stress it beyond `material.yield_stress`";
  return "";
}

}  // namespace

const std::vector<MaterialLaw>& material_laws() {
  static const std::vector<MaterialLaw> laws{
      {.name = "linear",
       .formula = "sigma = E (lambda - 1), small strain, nothing moves",
       .small_strain = true,
       .make = simple<Linear>},
      {.name = "rate",
       .formula = "sigma = E (1 - 1/lambda), the integral of d(sigma) = (E - sigma) d(epsilon)",
       .make = simple<Rate>},
      {.name = "hencky", .formula = "sigma = E ln(lambda) / lambda", .make = simple<Hencky>},
      {.name = "neo-hookean", .formula = "sigma = (E/2) (lambda - 1/lambda)", .make = simple<NeoHookean>},
      {.name = "elastoplastic",
       .formula = "as linear up to the yield stress, then with linear kinematic hardening",
       .small_strain = true,
       .parameters = {{.name = "yield_stress",
                       .unit = "Pa",
                       .meaning = "at which the undeformed material yields",
                       .minimum = 0.0,
                       .minimum_excluded = true},
                      {.name = "tangent_modulus",
                       .unit = "Pa",
                       .meaning = "d(stress)/d(strain) while it yields, below Young's modulus",
                       .minimum = 0.0}},
       .make = elastoplastic,
       .conflict = conflict_of_elastoplastic},
  };
  return laws;
}

const MaterialLaw& find_law(const std::string& name) {
  std::string names;
  for (const MaterialLaw& law : material_laws()) {
    if (law.name == name) return law;
    names += (names.empty() ? "" : ", ") + law.name;
  }
  throw Error("unknown law \"" + name + "\"; the laws are " + names);
}

bool has_memory(const MaterialSpec& spec) {
  return std::visit([]<class Law>(const Law&) { return HasMemory<Law>; }, make_material(spec));
}

}  // namespace hompm
