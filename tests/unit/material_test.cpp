#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/materials/material.hpp>

#include "support/catch.hpp"

namespace {

using namespace hompm;

constexpr double youngs_modulus = 250.0;
constexpr double epsilon = std::numeric_limits<double>::epsilon();
const std::vector<std::string> names{"linear", "rate", "hencky", "neo-hookean"};
const std::vector<double> stretches{0.05, 0.2, 0.5, 0.9, 0.999999, 1.0, 1.000001, 1.1, 1.5, 2.0, 2.6};

/// Calls check(law, λ) for every law and stretch.
template <class Check>
void for_all(Check check) {
  for (const std::string& name : names) {
    for (const double stretch : stretches) {
      INFO(name << " at stretch " << stretch);
      std::visit([&](const auto& law) { check(law, stretch); }, make_material({name, 1.0, youngs_modulus}));
    }
  }
}

/// Central difference quotient with the step 1e-5 λ. Every law is a sum of powers of λ of order one and
/// logarithms, so that the error is below (1e-5)² times the size of its terms; rounding adds about 1e-16/1e-5
/// of that.
template <class Function>
double derivative(Function function, double stretch) {
  const double step = 1e-5 * stretch;
  const double above = stretch + step;
  const double below = stretch - step;
  return (function(above) - function(below)) / (above - below);
}
constexpr double derivative_tolerance = 1e-9;

}  // namespace

TEST_CASE("at rest every law is free of stress and has Young's modulus as tangent", "[material]") {
  for (const std::string& name : names) {
    INFO(name);
    std::visit(
        [](const auto& law) {
          CHECK(law.stress(1.0) == 0.0);
          CHECK(law.tangent(1.0) == youngs_modulus);
          CHECK(law.modulus(0.0, 1.0) == youngs_modulus);
          CHECK(law.stored_energy(1.0) == 0.0);
          CHECK(law.stretch(0.0) == 1.0);
        },
        make_material({name, 1.0, youngs_modulus}));
  }
}

TEST_CASE("the tangent is the derivative of the stress", "[material]") {
  for_all([](const auto& law, double stretch) {
    const double quotient = derivative([&](double s) { return law.stress(s); }, stretch);
    const double size =
        youngs_modulus * (1.0 + 1.0 / (stretch * stretch)) * (1.0 + std::abs(std::log(stretch)));
    CHECK(std::abs(law.tangent(stretch) - quotient) <= derivative_tolerance * size);
  });
}

TEST_CASE("the stress is the derivative of the stored energy", "[material]") {
  for_all([](const auto& law, double stretch) {
    const double quotient = derivative([&](double s) { return law.stored_energy(s); }, stretch);
    const double size = youngs_modulus * (stretch + 1.0 / stretch) * (1.0 + std::abs(std::log(stretch)));
    CHECK(std::abs(law.stress(stretch) - quotient) <= derivative_tolerance * size);
    if (stretch != 1.0) CHECK(law.stored_energy(stretch) > 0.0);
  });
}

TEST_CASE("the modulus of the incremental update agrees with the tangent", "[material]") {
  // dσ = (dσ/dλ) dλ and dλ = λ dε; for the small-strain law, dλ = dε.
  for_all([](const auto& law, double stretch) {
    const bool small_strain = std::is_same_v<std::decay_t<decltype(law)>, Linear>;
    const double expected = (small_strain ? 1.0 : stretch) * law.tangent(stretch);
    // A handful of roundings, of terms no larger than these.
    const double size = youngs_modulus * (stretch + 1.0 / stretch) * (1.0 + std::abs(std::log(stretch)));
    CHECK(std::abs(law.modulus(law.stress(stretch), stretch) - expected) <= 8.0 * epsilon * size);
  });
}

TEST_CASE("the stretch of a stress undoes the stress of a stretch", "[material]") {
  for_all([](const auto& law, double stretch) {
    // The rounding of the stress, magnified by dλ/dσ; near λ = 1 its terms E cancel.
    const double size = stretch + (youngs_modulus + std::abs(law.stress(stretch))) / law.tangent(stretch);
    CHECK(std::abs(law.stretch(law.stress(stretch)) - stretch) <= 8.0 * epsilon * size);
  });
}

TEST_CASE("strong compression loses no digits", "[material]") {
  // λ → E/(2|σ|) − …: with σ = −10⁸ E the naive root τ + √(τ² + 1) would have no correct digit.
  const NeoHookean law{1.0};
  CHECK(std::abs(law.stretch(-1e8) * 2e8 - 1.0) <= 4.0 * epsilon);
  const Hencky hencky{1.0};
  const double stretch = hencky.stretch(-1e8);
  CHECK(std::abs(hencky.stress(stretch) / -1e8 - 1.0) <= 16.0 * epsilon);
}

TEST_CASE("hencky has a greatest stress", "[material]") {
  const Hencky law{1.0};
  const double e = std::exp(1.0);
  // At the maximum λ moves with the root of the stress: half of the digits remain.
  CHECK(std::abs(law.stretch(1.0 / e) - e) <= 1e-7);
  CHECK(law.stretch(0.367) < e);
  CHECK_THROWS_AS(law.stretch(0.3679), Error);
  CHECK_THROWS_AS(law.stretch(std::numeric_limits<double>::quiet_NaN()), Error);
}

TEST_CASE("laws are made by their names", "[material]") {
  REQUIRE(material_laws().size() == names.size() + 1);  // that with memory has more parameters
  for (std::size_t i = 0; i < names.size(); ++i) {
    CHECK(material_laws()[i].name == names[i]);
    CHECK(make_material({names[i], 1.0, youngs_modulus}).index() == i);
  }
  CHECK_THROWS_AS(make_material({"elastic", 1.0, youngs_modulus}), Error);
}
