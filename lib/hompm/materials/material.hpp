// The constitutive laws in uniaxial strain (docs/method.md, "Materials"). Each law is a type with the same
// members; code that loops over particles is a template over the law, chosen once by `std::visit`.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <hompm/numerics/elementary.hpp>
#include <hompm/scene/scene.hpp>

namespace hompm {

/// σ = E (λ − 1), the small-strain law.
struct Linear {
  double youngs_modulus;  ///< Pa
  /// Cauchy stress (Pa) at stretch λ.
  [[nodiscard]] double stress(double stretch) const { return youngs_modulus * (stretch - 1.0); }
  /// dσ/dλ (Pa) at stretch λ.
  [[nodiscard]] double tangent(double /*stretch*/) const { return youngs_modulus; }
  /// dσ/dε (Pa), with dε = ∂v/∂x dt, at stress σ and stretch λ: what the incremental update multiplies with.
  [[nodiscard]] double modulus(double /*stress*/, double /*stretch*/) const { return youngs_modulus; }
  /// ψ(λ) = ∫ σ dλ from 1 (J per m³ of undeformed material).
  [[nodiscard]] double stored_energy(double stretch) const {
    return 0.5 * youngs_modulus * (stretch - 1.0) * (stretch - 1.0);
  }
  /// λ at which the law gives the stress σ (Pa).
  [[nodiscard]] double stretch(double stress) const { return 1.0 + stress / youngs_modulus; }
};

/// dσ = E dε − σ dε, integrated: σ = E (1 − 1/λ). The law of the benchmarks of Tielen et al. (2017).
struct Rate {
  double youngs_modulus;
  [[nodiscard]] double stress(double stretch) const { return youngs_modulus * (1.0 - 1.0 / stretch); }
  [[nodiscard]] double tangent(double stretch) const { return youngs_modulus / (stretch * stretch); }
  [[nodiscard]] double modulus(double stress, double /*stretch*/) const { return youngs_modulus - stress; }
  [[nodiscard]] double stored_energy(double stretch) const {
    return youngs_modulus * ((stretch - 1.0) - numerics::log(stretch));
  }
  [[nodiscard]] double stretch(double stress) const { return 1.0 / (1.0 - stress / youngs_modulus); }
};

/// σ = E ln λ / λ.
struct Hencky {
  double youngs_modulus;
  [[nodiscard]] double stress(double stretch) const {
    return youngs_modulus * numerics::log(stretch) / stretch;
  }
  [[nodiscard]] double tangent(double stretch) const {
    return youngs_modulus * (1.0 - numerics::log(stretch)) / (stretch * stretch);
  }
  [[nodiscard]] double modulus(double stress, double stretch) const {
    return youngs_modulus / stretch - stress;
  }
  [[nodiscard]] double stored_energy(double stretch) const {
    const double strain = numerics::log(stretch);
    return 0.5 * youngs_modulus * strain * strain;
  }
  /// The branch λ < e, on which σ grows with λ; throws `Error` above its maximum E/e.
  [[nodiscard]] double stretch(double stress) const;
};

/// σ = (E/2)(λ − 1/λ).
struct NeoHookean {
  double youngs_modulus;
  [[nodiscard]] double stress(double stretch) const {
    return 0.5 * youngs_modulus * (stretch - 1.0 / stretch);
  }
  [[nodiscard]] double tangent(double stretch) const {
    return 0.5 * youngs_modulus * (1.0 + 1.0 / (stretch * stretch));
  }
  [[nodiscard]] double modulus(double /*stress*/, double stretch) const {
    return 0.5 * youngs_modulus * (stretch + 1.0 / stretch);
  }
  [[nodiscard]] double stored_energy(double stretch) const {
    return 0.5 * youngs_modulus * (0.5 * (stretch * stretch - 1.0) - numerics::log(stretch));
  }
  [[nodiscard]] double stretch(double stress) const;
};

using Material = std::variant<Linear, Rate, Hencky, NeoHookean>;

/// Name and formula of each law, in the order of `Material`.
const std::vector<std::pair<std::string, std::string>>& material_laws();

/// The law of a scene. Throws `Error` for a name that is none of linear, rate, hencky, neo-hookean.
Material make_material(const MaterialSpec& spec);

}  // namespace hompm
