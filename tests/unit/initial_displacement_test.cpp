// A body that starts displaced: stretch, stress, volumes and ends go with it.
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/verify/judge.hpp>
#include <hompm/materials/material.hpp>
#include <hompm/plan/state.hpp>
#include <hompm/reference/loads.hpp>
#include <hompm/reference/method_of_lines.hpp>
#include <hompm/reference/reference.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"

using namespace hompm;

namespace {

Scene scene_of(const std::string& law, const std::string& more, const std::string& scheme = "tielen2017") {
  return parse_scene(R"(
end_time = 0.13
body = { length = 2, start = 3 }
material = { law = ")" + law +
                         R"(", density = 1000, youngs_modulus = 1e5 }
scheme = { name = ")" + scheme +
                         R"(", cells = 16, particles_per_cell = 4, step_fraction = 0.1 }
)" + more,
                     "initial displacement", {});
}

const std::string stretched =
    "ends.right = \"free\"\ninitial.displacement = { shape = \"linear\", amplitude = 0, gradient = 0.25 }\n";
const std::string wave = "initial.displacement = { shape = \"sine\", amplitude = -0.05, mode = 2 }\n";

/// Relative L2 error of the displacement at the end.
double error_of(const Scene& scene) {
  const RunResult result = run(scene, time_stepping(scene));
  std::string reason;
  const auto errors = judge(scene, result, reason);
  INFO(reason);
  REQUIRE(errors);
  return errors->displacement.relative_l2;
}

}  // namespace

TEST_CASE("A displaced body starts with the stretch, the stress and the volumes of its displacement") {
  for (const std::string law : {"rate", "hencky", "neo-hookean"})
    for (const std::string scheme : {"classical", "tielen2017", "high-order"}) {
      INFO(law << ", " << scheme);
      const Scene scene = scene_of(law, stretched, scheme);
      const State state = initial_state(scene);
      const double stress =
          std::visit([](const auto& of) { return of.stress(1.25); }, make_material(scene.material));
      const Particles& p = state.particles;
      for (std::size_t i = 0; i < p.size(); ++i) {
        CHECK(p.stretch[i] == 1.25);
        CHECK(p.stress[i] == stress);
        CHECK(p.volume[i] == 1.25 * p.reference_volume[i]);
        CHECK(std::abs(p.displacement[i] - 0.25 * (p.reference_position[i] - 3.0)) < 1e-15);
        CHECK(p.position[i] == p.reference_position[i] + p.displacement[i]);
      }
      CHECK(state.left_boundary == 3.0);
      CHECK(state.right_boundary == 5.5);
    }
}

TEST_CASE("With infinitesimal kinematics nothing moves, displaced or not") {
  const State state = initial_state(scene_of("linear", stretched));
  CHECK(state.particles.position == state.particles.reference_position);
  CHECK(state.particles.volume == state.particles.reference_volume);
  CHECK(state.particles.stress.front() == 0.25 * 1e5);
  CHECK(state.right_boundary == 5.0);
}

TEST_CASE("The stretch at the start is the gradient of the displacement") {
  const Scene scene = scene_of("rate", wave);
  const Particles p = initial_state(scene).particles;
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    const double slope =
        (p.position[i + 1] - p.position[i - 1]) / (p.reference_position[i + 1] - p.reference_position[i - 1]);
    CHECK(std::abs(p.stretch[i] - slope) < 2e-3 * 0.157);  // (k h)²/6 of the largest gradient
  }
}

TEST_CASE("The initial displacement is written and read again, and only where it is given") {
  const Scene scene = scene_of("rate", wave);
  const std::string text = scene_text(scene);
  CHECK(text.find("[initial.displacement]\nshape = \"sine\"\namplitude = -0.05  # m\nmode = 2\n") !=
        std::string::npos);
  CHECK(scene_text(parse_scene(text, "again", {})) == text);
  CHECK(scene_text(scene_of("rate", "")).find("[initial") == std::string::npos);
}

TEST_CASE("A bar let go from a sine is a standing wave, in closed form and by the method of lines") {
  const Scene scene = scene_of("linear", wave + "initial.velocity = { shape = \"sine\", amplitude = 0.3 }\n");
  const std::vector<double> X{3.1, 3.7, 4.0, 4.45};
  std::vector<double> places;
  for (const double x : X) places.push_back(x - 3.0);
  const auto reference = make_reference(scene);
  REQUIRE(reference);
  const ReferenceFields exact = reference->at(0.13, X);
  const ReferenceFields lines =
      method_of_lines(scene, *loads_of(scene), Resolution{16, 12, 0.1})(0.13, places);
  for (std::size_t i = 0; i < X.size(); ++i) {
    // Runge–Kutta of fourth order at a tenth of its stable step
    CHECK(std::abs(exact.displacement[i] - lines.displacement[i]) < 1e-9);
    CHECK(std::abs(exact.velocity[i] - lines.velocity[i]) < 1e-7);
    CHECK(std::abs(exact.stress[i] - lines.stress[i]) < 1e-3);
  }
}

TEST_CASE("A bar let go converges to the standing wave at the order of the scheme") {
  for (const auto& [scheme, least] :
       {std::pair("classical", 1.7), {"bspline", 1.7}, {"cpdi", 1.7}, {"high-order", 2.9}}) {
    INFO(scheme);
    Scene scene = scene_of("linear", wave, scheme);
    scene.scheme.step_fraction.reset();
    scene.scheme.time_step = 2e-5;  // the error of the step is below that of the cells
    const double coarse = error_of(scene);
    scene.scheme.cells *= 2;
    CHECK(std::log2(coarse / error_of(scene)) > least);
  }
}

TEST_CASE("A bar let go from large strain follows its law") {
  for (const std::string law : {"rate", "hencky", "neo-hookean"}) {
    INFO(law);
    Scene scene = scene_of(law, wave, "high-order");
    scene.scheme.cells = 48;
    CHECK(error_of(scene) < 1e-3);
  }
}
