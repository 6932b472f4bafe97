// The constitutive laws in uniaxial strain (docs/method.md, "Materials"). Each law is a type with the same
// members; code that loops over particles is a template over the law, chosen once by `std::visit`.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
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

/// What a law remembers of each particle, zero at the start.
struct InternalField {
  std::string_view name, unit, meaning;
};

/// σ = E (λ − 1 − ε_p), of small strain, with |σ − H ε_p| ≤ σ_y: linear kinematic hardening (Prager).
struct Elastoplastic : Linear {
  double yield_stress;  ///< σ_y, Pa, of the undeformed material
  double hardening;     ///< H, Pa: E_t = E H/(E + H) while it yields

  using Elastic = Linear;  ///< of a step in which nothing internal changes
  static constexpr std::array internal_fields{InternalField{"plastic_strain", "–", "ε_p of the law"}};
  using Internal = std::array<double, internal_fields.size()>;  ///< of one particle

  using Linear::stress;
  /// σ (Pa) at the stretch while what is internal stays.
  [[nodiscard]] double stress(double stretch, const Internal& internal) const {
    return stress(stretch) - youngs_modulus * internal[0];
  }
  /// Takes a stress (Pa) beyond the yield stress back to it, and changes what is internal: the return map,
  /// which is exact for this law (Simo, Hughes, Computational Inelasticity, 1998, section 1.6). Returns what
  /// that dissipates (J/m³).
  double correct(double& stress, Internal& internal) const {
    const double relative = stress - hardening * internal[0];
    const double over = std::abs(relative) - yield_stress;
    if (!(over > 0.0)) return 0.0;
    const double flow = over / (youngs_modulus + hardening);
    const double change = relative > 0.0 ? flow : -flow;
    stress -= youngs_modulus * change;
    internal[0] += change;
    return yield_stress * flow;
  }
  /// Energy (J/m³) beside ψ(λ): E (ε − ε_p)²/2 + H ε_p²/2 in all.
  [[nodiscard]] double stored_beside(double stretch, const Internal& internal) const {
    const double plastic = internal[0];
    return plastic * (0.5 * (youngs_modulus + hardening) * plastic - youngs_modulus * (stretch - 1.0));
  }
};

/// A law whose stress depends on more than the stretch: it has what `Elastoplastic` has beside a `Linear`.
template <class Law>
concept HasMemory = requires {
  typename Law::Internal;
};

using Material = std::variant<Linear, Rate, Hencky, NeoHookean, Elastoplastic>;

/// A parameter of a law, beside density and Young's modulus: a key of [material].
struct LawParameter {
  std::string name, unit, meaning;
  double minimum = -std::numeric_limits<double>::infinity();
  bool minimum_excluded = false;
};

/// One row of the table of laws.
struct MaterialLaw {
  std::string name;
  std::string formula;
  bool small_strain = false;  ///< nothing moves
  std::vector<LawParameter> parameters = {};
  Material (*make)(const MaterialSpec& spec);
  /// Why the law does not go with the rest of a scene that is otherwise complete; null, "": it does.
  std::string (*conflict)(const Scene& scene) = nullptr;
};

/// The laws, in the order in which `--list` shows them.
const std::vector<MaterialLaw>& material_laws();

/// The row of a law. Throws `Error` where there is none.
const MaterialLaw& find_law(const std::string& name);

/// The law of a scene. Throws as `find_law`.
inline Material make_material(const MaterialSpec& spec) { return find_law(spec.law).make(spec); }

/// Whether the law remembers more than the stretch.
bool has_memory(const MaterialSpec& spec);

}  // namespace hompm
