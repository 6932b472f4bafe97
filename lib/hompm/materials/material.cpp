#include <algorithm>
#include <cmath>

#include <hompm/error.hpp>
#include <hompm/materials/material.hpp>
#include <hompm/number.hpp>

namespace hompm {

double Hencky::stretch(double stress) const {
  constexpr double e = 2.718281828459045;
  const double ratio = stress / youngs_modulus;
  if (!(ratio <= 1.0 / e)) {
    throw Error("the law hencky reaches at most the stress E/e = " + to_text(youngs_modulus / e) + " Pa");
  }
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

const std::vector<std::pair<std::string, std::string>>& material_laws() {
  static const std::vector<std::pair<std::string, std::string>> laws{
      {"linear", "sigma = E (lambda - 1), small strain, nothing moves"},
      {"rate", "sigma = E (1 - 1/lambda), the integral of d(sigma) = (E - sigma) d(epsilon)"},
      {"hencky", "sigma = E ln(lambda) / lambda"},
      {"neo-hookean", "sigma = (E/2) (lambda - 1/lambda)"},
  };
  return laws;
}

Material make_material(const MaterialSpec& spec) {
  if (spec.law == "linear") return Linear{spec.youngs_modulus};
  if (spec.law == "rate") return Rate{spec.youngs_modulus};
  if (spec.law == "hencky") return Hencky{spec.youngs_modulus};
  if (spec.law == "neo-hookean") return NeoHookean{spec.youngs_modulus};
  throw Error("unknown law \"" + spec.law + "\"; the laws are linear, rate, hencky, neo-hookean");
}

}  // namespace hompm
