#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/materials/material.hpp>
#include <hompm/numerics/gauss_legendre.hpp>
#include <hompm/reference/method_of_lines.hpp>
#include <hompm/reference/reference.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace {

using namespace hompm;
constexpr double pi = 3.141592653589793;

EffectSpec effect(const std::string& type, std::map<std::string, EffectSpec::Value> parameters) {
  return {type, std::move(parameters), {}};
}

/// The built-in bar: L = 25 m, ρ0 = 1 kg/m³, E = 100 Pa, c = 10 m/s.
Scene bar(const std::string& law, double amplitude, int mode = 1) {
  Scene scene;
  scene.body.length = 25.0;
  scene.material = {law, 1.0, 100.0};
  scene.initial_velocity = InitialField{"sine", amplitude, mode};
  return scene;
}

/// The built-in column: H = 1 m, ρ0 = 1000 kg/m³, E = 10⁵ Pa, c = 10 m/s, under gravity.
Scene column(const std::string& law) {
  Scene scene;
  scene.body.length = 1.0;
  scene.material = {law, 1000.0, 1e5};
  scene.ends.right = End::free;
  scene.effects.push_back(effect("gravity", {{"acceleration", -9.81}, {"ramp_time", 0.0}}));
  return scene;
}

std::vector<double> points(double length, int n) {
  std::vector<double> X;
  for (int i = 0; i < n; ++i) X.push_back(length * (i + 0.5) / n);
  return X;
}

/// ‖a − b‖/‖b‖
double distance(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double difference = 0.0;
  double norm = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference += (a[i] - b[i]) * (a[i] - b[i]);
    norm += b[i] * b[i];
  }
  return std::sqrt(difference / norm);
}

Reference reference(const Scene& scene) {
  auto found = make_reference(scene);
  REQUIRE(found);
  return *found;
}

FieldsAt lines(const Scene& scene, const Resolution& resolution) {
  return method_of_lines(scene, *loads_of(scene), resolution);
}

}  // namespace

TEST_CASE("the small-strain column is the sum of its Fourier series", "[reference]") {
  const Scene scene = column("linear");
  const Reference found = reference(scene);
  CHECK(found.estimated_error().displacement == 0.0);
  const std::vector<double> X = points(1.0, 13);
  const double g = 9.81, H = 1.0, E = 1e5, rho = 1000.0, c = 10.0;
  constexpr int terms = 4000;
  for (const double time : {0.03, 0.1, 0.17, 0.2, 0.29, 0.4, 0.55, 2.5}) {
    const ReferenceFields fields = found.at(time, X);
    for (std::size_t i = 0; i < X.size(); ++i) {
      double u = rho * g / E * (0.5 * X[i] * X[i] - H * X[i]);
      double v = 0.0;
      double stress = rho * g * (X[i] - H);
      for (int k = 1; k <= terms; ++k) {
        const double wave = (2 * k - 1) * pi / (2.0 * H);
        const double factor = 2.0 * rho * g / (E * H * wave * wave * wave);
        u += factor * std::cos(wave * c * time) * std::sin(wave * X[i]);
        v -= factor * wave * c * std::sin(wave * c * time) * std::sin(wave * X[i]);
        stress += E * factor * wave * std::cos(wave * c * time) * std::cos(wave * X[i]);
      }
      INFO("t = " << time << ", X = " << X[i]);
      // The terms left out: Σ 1/(2k−1)³ < 1/(16 K²), Σ 1/(2k−1)² < 1/(4 K).
      const double rest3 = 1.0 / (15.0 * terms * terms);
      const double rest2 = 1.0 / (3.9 * terms);
      CHECK(std::abs(fields.displacement[i] - u) <= 16.0 * rho * g * H * H / (pi * pi * pi * E) * rest3);
      CHECK(std::abs(fields.velocity[i] - v) <= 8.0 * rho * g * H * c / (pi * pi * E) * rest2);
      CHECK(std::abs(fields.stress[i] - stress) <= 8.0 * rho * g * H / (pi * pi) * rest2);
    }
  }
}

TEST_CASE("the method of lines finds the standing wave", "[reference]") {
  const Scene scene = bar("linear", 0.3, 3);
  const Reference exact = reference(scene);
  CHECK(exact.estimated_error().displacement == 0.0);
  const FieldsAt numerical = lines(scene, {16, 12, 0.25});
  const std::vector<double> X = points(25.0, 40);
  for (const double time : {0.0, 0.7, 4.0}) {
    const ReferenceFields a = numerical(time, X);
    const ReferenceFields b = exact.at(time, X);
    CHECK(distance(a.velocity, b.velocity) < 1e-9);
    if (time == 0.0) continue;
    CHECK(distance(a.displacement, b.displacement) < 1e-9);
    CHECK(distance(a.stress, b.stress) < 1e-9);
  }
}

TEST_CASE("mass-proportional damping halves its rate in a mode", "[reference]") {
  Scene scene = bar("linear", 0.3);
  const double beta = 0.8, omega0 = pi * 10.0 / 25.0, time = 3.1;
  scene.effects.push_back(effect("mass-damping", {{"rate", beta}}));
  const std::vector<double> X = points(25.0, 9);
  const ReferenceFields fields = reference(scene).at(time, X);
  const double omega = std::sqrt(omega0 * omega0 - 0.25 * beta * beta);
  std::vector<double> exact;
  for (const double x : X) {
    exact.push_back(0.3 / omega * std::exp(-0.5 * beta * time) * std::sin(omega * time) *
                    std::sin(pi * x / 25.0));
  }
  CHECK(distance(fields.displacement, exact) < 1e-10);
}

TEST_CASE("viscosity damps a mode with half of the viscosity times its wave number squared", "[reference]") {
  Scene scene = bar("linear", 0.3);
  scene.kinematics = hompm::Kinematics::infinitesimal;
  const double eta = 20.0, k = pi / 25.0, omega0 = 10.0 * k, time = 3.1;
  scene.effects.push_back(effect("viscosity", {{"viscosity", eta}}));
  const std::vector<double> X = points(25.0, 9);
  const ReferenceFields fields = reference(scene).at(time, X);
  const double decay = 0.5 * eta * k * k;  // for a density of 1
  const double omega = std::sqrt(omega0 * omega0 - decay * decay);
  std::vector<double> exact;
  for (const double x : X)
    exact.push_back(0.3 / omega * std::exp(-decay * time) * std::sin(omega * time) * std::sin(k * x));
  CHECK(distance(fields.displacement, exact) < 1e-10);
}

TEST_CASE("a step of traction sends d'Alembert's wave", "[reference]") {
  // Until the wave is back the loaded end moves at p/(ρ0 c); rounding of one reflection.
  const double p = 200.0, time = 0.13;
  for (const bool right : {true, false}) {
    Scene scene = column("linear");
    scene.ends = right ? Ends{End::fixed, End::free} : Ends{End::free, End::fixed};
    scene.effects = {
        effect("traction", {{"end", right ? "right" : "left"}, {"value", p}}),
        effect("traction", {{"end", right ? "left" : "right"}, {"value", 1e4}})};  // on the support
    const ReferenceFields fields = reference(scene).at(time, std::vector<double>{0.0, 0.5, 1.0});
    const double sign = right ? 1.0 : -1.0;
    CHECK(std::abs(sign * fields.displacement[right ? 2 : 0] - p * time / 1e4) < 1e-16);
    CHECK(std::abs(sign * fields.displacement[1] - p * (time - 0.05) / 1e4) < 1e-16);
    CHECK(std::abs(fields.displacement[right ? 0 : 2]) < 1e-16);
  }
}

TEST_CASE("a column without a solution of its own has the method of lines", "[reference]") {
  CHECK(reference(column("neo-hookean")).description.starts_with("method of lines"));
}

TEST_CASE("a free body falls as one", "[reference]") {
  Scene scene = column("neo-hookean");
  scene.ends.left = End::free;
  const ReferenceFields fields = reference(scene).at(0.2, points(1.0, 5));
  for (const double u : fields.displacement) CHECK(std::abs(u + 0.5 * 9.81 * 0.04) < 1e-12);
  for (const double stress : fields.stress) CHECK(std::abs(stress) < 1e-6);  // rounding of u, times E/h
}

TEST_CASE("the method of lines converges spectrally in space and with order four in time", "[reference]") {
  const Scene scene = bar("rate", 1.0);
  const std::vector<double> X = points(25.0, 50);
  const std::vector<double> exact = lines(scene, {24, 12, 0.2})(4.0, X).displacement;
  const auto error = [&](const Resolution& r) {
    return distance(lines(scene, r)(4.0, X).displacement, exact);
  };
  CHECK(error({2, 10, 0.1}) / error({4, 10, 0.1}) > 30.0);
  CHECK(error({4, 6, 0.1}) / error({4, 12, 0.1}) > 1e3);
  const double order = std::log2(error({8, 12, 1.0}) / error({8, 12, 0.5}));
  CHECK(std::abs(order - 4.0) < 0.1);
}

TEST_CASE("the reference of the large-strain bar is as good as it says", "[reference]") {
  const Scene scene = bar("rate", 1.0);
  const std::vector<double> X = points(25.0, 256);
  const Reference found = reference(scene);
  const ReferenceFields fields = found.at(4.0, X);
  const ReferenceFields finer = lines(scene, {32, 12, 0.2})(4.0, X);
  const ReferenceErrors own = found.estimated_error();
  const auto check = [](double error, double estimate) {
    CHECK(error < 1e-10);
    CHECK(estimate > error);
    CHECK(estimate < 1e-9);
  };
  check(distance(fields.displacement, finer.displacement), own.displacement);
  check(distance(fields.velocity, finer.velocity), own.velocity);
  check(distance(fields.stress, finer.stress), own.stress);
}

TEST_CASE("the method of lines conserves energy for every law", "[reference]") {
  const numerics::GaussRule rule = numerics::gauss_legendre(12);
  std::vector<double> X;
  constexpr int panels = 16;
  for (int panel = 0; panel < panels; ++panel) {
    for (const double point : rule.points) X.push_back(25.0 / panels * (panel + point));
  }
  for (const auto& law_row : material_laws()) {
    const std::string& name = law_row.name;
    INFO(name);
    if (!law_row.parameters.empty()) continue;  // a law with memory has no reference
    const Scene scene = bar(name, 1.0);
    const ReferenceFields fields = lines(scene, {16, 12, 0.25})(3.0, X);
    const double energy = std::visit(
        [&](const auto& law) {
          double sum = 0.0;
          for (std::size_t i = 0; i < X.size(); ++i) {
            const double density = 0.5 * fields.velocity[i] * fields.velocity[i] +
                                   law.stored_energy(law.stretch(fields.stress[i]));
            sum += 25.0 / panels * rule.weights[i % rule.weights.size()] * density;
          }
          return sum;
        },
        make_material(scene.material));
    CHECK(std::abs(energy / (0.25 * 25.0) - 1.0) < 1e-10);  // ½ ∫ sin²(πX/L) dX = L/4
  }
}

TEST_CASE("equilibrium of the law rate in closed form", "[reference]") {
  Scene scene = column("rate");
  scene.material.youngs_modulus = 1e4;
  scene.rest = Rest{.speed = 1e-6, .earliest = {}};
  scene.effects.push_back(effect("local-damping", {{"coefficient", 0.7}}));
  const std::vector<double> X = points(1.0, 31);
  const Reference found = reference(scene);
  const ReferenceFields fields = found.at(10.0, X);
  CHECK(found.estimated_error().displacement == 0.0);
  const double a = 0.981;
  for (std::size_t i = 0; i < X.size(); ++i) {
    const double x = std::log((1.0 + a) / (1.0 + a * (1.0 - X[i]))) / a;
    CHECK(std::abs(fields.displacement[i] - (x - X[i])) < 1e-15);  // a few ulps of x
    CHECK(std::abs(fields.stress[i] + 9810.0 * (1.0 - X[i])) < 1e-11);
    CHECK(fields.velocity[i] == 0.0);
  }
  scene.effects.push_back(effect("traction", {{"end", "right"}, {"value", 1.1e4}}));
  CHECK_THROWS_AS(reference(scene).at(10.0, X), Error);  // the law reaches at most E
}

TEST_CASE("equilibrium of every law, from either side", "[reference]") {
  const std::vector<double> X{0.1, 0.399999, 0.400001, 0.8, 1.0};
  for (const auto& law_row : material_laws()) {
    const std::string& name = law_row.name;
    INFO(name);
    if (!law_row.parameters.empty()) continue;  // a law with memory has no reference
    Scene scene = column(name);
    scene.material.youngs_modulus = 3e4;
    scene.rest = Rest{.speed = 1e-6, .earliest = {}};
    scene.effects.push_back(effect("traction", {{"end", "right"}, {"value", 2e3}}));
    const ReferenceFields fields = reference(scene).at(1.0, X);
    CHECK(fields.stress.back() == 2e3);
    const double stretch = std::visit([](const auto& law) { return law.stretch(2e3 - 9810.0 * 0.6); },
                                      make_material(scene.material));
    const double quotient = 1.0 + (fields.displacement[2] - fields.displacement[1]) / (X[2] - X[1]);
    CHECK(std::abs(quotient - stretch) < 1e-9);  // rounding over the distance 2e-6

    scene.ends = {End::free, End::fixed};
    scene.effects = {effect("gravity", {{"acceleration", 9.81}, {"ramp_time", 0.0}}),
                     effect("traction", {{"end", "left"}, {"value", 2e3}})};
    std::vector<double> mirrored;
    for (std::size_t i = X.size(); i-- > 0;) mirrored.push_back(1.0 - X[i]);
    const ReferenceFields other = reference(scene).at(1.0, mirrored);
    for (std::size_t i = 0; i < X.size(); ++i) {
      CHECK(std::abs(other.displacement[X.size() - 1 - i] + fields.displacement[i]) < 1e-15);
      CHECK(std::abs(other.stress[X.size() - 1 - i] - fields.stress[i]) < 1e-11);
    }
  }
}

TEST_CASE("loads of one kind add up", "[reference]") {
  Scene twice = column("rate");
  twice.effects = {effect("gravity", {{"acceleration", -4.0}, {"ramp_time", 0.0}}),
                   effect("gravity", {{"acceleration", -4.0}, {"ramp_time", 0.0}})};
  Scene once = column("rate");
  once.effects = {effect("gravity", {{"acceleration", -8.0}, {"ramp_time", 0.0}})};
  const std::vector<double> X = points(1.0, 7);
  CHECK(reference(twice).at(0.3, X).displacement == reference(once).at(0.3, X).displacement);
}

TEST_CASE("where no reference is known there is none", "[reference]") {
  Scene scene = column("rate");
  scene.effects.push_back(effect("local-damping", {{"coefficient", 0.7}}));
  CHECK_FALSE(make_reference(scene));
  scene.rest = Rest{.speed = 1e-6, .earliest = {}};
  CHECK(make_reference(scene));
  scene.effects.push_back(effect("earthquake", {}));
  CHECK_FALSE(make_reference(scene));
  scene = bar("rate", 1.0);
  scene.kinematics = Kinematics::infinitesimal;
  CHECK_FALSE(make_reference(scene));
  scene.material.law = "linear";
  CHECK(make_reference(scene));
  scene.rest = Rest{.speed = 1e-6, .earliest = {}};
  CHECK_FALSE(make_reference(scene));  // nothing holds its place between two fixed ends but the history
}

TEST_CASE("the method of lines refuses to go back, and to go on where the material turns inside out",
          "[reference]") {
  const Reference found = reference(bar("rate", 5.0));
  const std::vector<double> X = points(25.0, 4);
  found.at(1.0, X);
  found.at(1.0, X);
  CHECK_THROWS_AS(found.at(0.9, X), Error);
  CHECK_THROWS_AS(found.at(20.0, X), Error);
  CHECK_THROWS_AS(found.at(20.0, X), Error);
}

TEST_CASE("an estimate of the error at one point is that of this point", "[reference]") {
  const auto reference = hompm::make_reference(hompm::test::built_in("bar", "large", {{"end_time", "0.5"}}));
  REQUIRE(reference);
  const std::vector<double> X{6.0};
  reference->at(0.5, X);
  CHECK(reference->estimated_error().displacement > 0.0);
}
