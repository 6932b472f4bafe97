// Exact solutions at points of one's own: closed forms, their jumps and kinks, and what is refused.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include <hompm/kit/verify/exact.hpp>
#include <hompm/reference/closed_forms.hpp>
#include <hompm/reference/method_of_lines.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/scenes.hpp"

namespace {

using namespace hompm;
using hompm::test::built_in;
using hompm::test::contains;
using hompm::test::message_of;

/// L = 1 m, ρ0 = 1000 kg/m³, E = 10⁵ Pa, c = 10 m/s; the rest of the scene is `more`.
Scene body(const std::string& law, const std::string& ends, const std::string& more) {
  return parse_scene("end_time = 2.0\nbody = { length = 1.0 }\n" + ends + "\nmaterial = { law = \"" + law +
                         "\", density = 1000.0, youngs_modulus = 1e5 }\n"
                         "scheme = { cells = 8, particles_per_cell = 2, step_fraction = 0.1 }\n" +
                         more,
                     "test", {});
}

const std::string fixed_fixed = "ends = { left = \"fixed\", right = \"fixed\" }";
const std::string fixed_free = "ends = { left = \"fixed\", right = \"free\" }";
const std::string free_free = "ends = { left = \"free\", right = \"free\" }";
const std::string gravity = "[[effect]]\ntype = \"gravity\"\nacceleration = -9.81\n";
const std::string pull = "[[effect]]\ntype = \"traction\"\nvalue = 500.0\n";

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

}  // namespace

TEST_CASE("travelling waves are the standing wave and the column's closed form", "[exact]") {
  const LinearBody small{1.0, 1000.0, 10.0};
  const std::vector<double> X{0.0, 0.1, 0.35, 0.6, 0.99, 1.0};
  const double k = 3.0 * M_PI;
  const double b = -9.81;
  for (const double time : {0.0, 0.03, 0.17, 0.29, 1.23}) {
    const auto column =
        travelling_waves({.body = small, .ends = {End::fixed, End::free}, .acceleration = b}, time, X);
    const auto bar = travelling_waves({.body = small, .velocity = InitialField{"sine", 0.3, 3}}, time, X);
    const auto released =
        travelling_waves({.body = small, .displacement = InitialField{"sine", 0.01, 3}}, time, X);
    double t = std::fmod(time, 0.4);  // two round trips, the second one backwards
    if (t > 0.2) t = 0.4 - t;
    for (std::size_t i = 0; i < X.size(); ++i) {
      const double x = X[i];
      // Rounding of a dozen reflections.
      CHECK(bar.displacement[i] ==
            Approx(0.3 / (10.0 * k) * std::sin(10.0 * k * time) * std::sin(k * x)).margin(1e-13));
      CHECK(bar.velocity[i] == Approx(0.3 * std::cos(10.0 * k * time) * std::sin(k * x)).margin(1e-12));
      CHECK(released.displacement[i] ==
            Approx(0.01 * std::cos(10.0 * k * time) * std::sin(k * x)).margin(1e-13));
      CHECK(released.stress[i] == Approx(1e3 * k * std::cos(10.0 * k * time) * std::cos(k * x)).margin(1e-8));
      const double up = std::max(t - x / 10.0, 0.0);
      const double down = std::max(t - (2.0 - x) / 10.0, 0.0);
      CHECK(column.displacement[i] == Approx(0.5 * b * (t * t - up * up - down * down)).margin(1e-13));
      CHECK(column.stress[i] == Approx(1e4 * b * (up - down)).margin(1e-8));
    }
  }
}

TEST_CASE("a pull that acts at once doubles at the fixed end, and turns back", "[exact]") {
  const Scene scene = body("linear", fixed_free, pull);
  // One crossing of the body takes 0.1 s.
  const std::vector<MaterialPoint> points{{0.15, 0.25}, {0.05, 0.25}, {0.05, 0.75}, {0.25, 0.75},
                                          {0.25, 0.25}, {0.4, 0.5},   {0.1, 1.0}};
  const ExactSolution exact = exact_solution(scene, points);
  CHECK_THAT(exact.reference, Catch::Contains("d'Alembert"));
  CHECK(exact.fields.error.stress.empty());
  const std::vector<double> stress{1000.0, 0.0, 500.0, 500.0, 1000.0, 0.0, 500.0};
  const double v = 500.0 / (1000.0 * 10.0);
  const std::vector<double> velocity{0.0, 0.0, v, -v, 0.0, 0.0, v};
  CHECK(largest_difference(exact.fields.stress, stress) < 1e-9);
  CHECK(largest_difference(exact.fields.velocity, velocity) < 1e-13);
  CHECK(exact.fields.displacement[6] == Approx(v * 0.1).epsilon(1e-13));
  CHECK(exact.fields.stretch[0] == Approx(1.01).epsilon(1e-14));

  REQUIRE(exact.breaks);
  const auto at = [&](double time, const std::string& field) {
    const auto found = std::ranges::find_if(
        *exact.breaks, [&](const FieldBreak& each) { return each.time == time && each.field == field; });
    REQUIRE(found != exact.breaks->end());
    return *found;
  };
  const FieldBreak jump = at(0.15, "stress");
  CHECK(jump.is_jump);
  CHECK(jump.X == Approx(0.5).epsilon(1e-14));
  CHECK(jump.left == Approx(1000.0).epsilon(1e-9));
  CHECK(jump.right == Approx(500.0).epsilon(1e-9));
  CHECK(at(0.15, "velocity").right == Approx(v).epsilon(1e-9));
  const FieldBreak kink = at(0.15, "displacement");
  CHECK_FALSE(kink.is_jump);
  CHECK(kink.left == Approx(0.01).epsilon(1e-9));
  CHECK(kink.right == Approx(0.005).epsilon(1e-9));
  // At 0.1 s the front is at the fixed end, at 0.4 s at the free one.
  CHECK(std::ranges::none_of(*exact.breaks, [](const FieldBreak& each) { return each.time == 0.1; }));
  CHECK(std::ranges::none_of(*exact.breaks, [](const FieldBreak& each) { return each.time == 0.4; }));
}

TEST_CASE("fronts from both ends of a free body, and a body that only falls", "[exact]") {
  const Scene stretched = body("linear", free_free,
                               "[initial.displacement]\nshape = \"linear\"\n"
                               "amplitude = 0.0\ngradient = 1e-3\n");
  // Both ends let go: the middle keeps its stress until the fronts meet there at 0.05 s.
  const std::vector<MaterialPoint> points{{0.03, 0.5}, {0.03, 0.1}, {0.03, 0.9}, {0.07, 0.5}};
  const ExactSolution exact = exact_solution(stretched, points);
  CHECK(largest_difference(exact.fields.stress, {100.0, 0.0, 0.0, -100.0}) < 1e-9);
  std::vector<double> places;
  for (const FieldBreak& found : *exact.breaks)
    if (found.time == 0.03 && found.field == "stress") places.push_back(found.X);
  REQUIRE(places.size() == 2);
  CHECK(largest_difference(places, {0.3, 0.7}) < 1e-15);

  const Scene falling = body("linear", free_free, gravity);
  const ExactSolution fall = exact_solution(falling, std::vector<MaterialPoint>{{0.7, 0.2}, {0.7, 0.9}});
  const double way = -0.5 * 9.81 * 0.49;
  CHECK(largest_difference(fall.fields.displacement, {way, way}) < 1e-13);
  CHECK(largest_difference(fall.fields.stress, {0.0, 0.0}) < 1e-9);
  CHECK(fall.breaks->empty());

  // What it starts with moves the right end, too: v0 = 1 m/s is no wave.
  const Scene flying =
      body("linear", free_free, "[initial.velocity]\nshape = \"uniform\"\namplitude = 1.0\n");
  const ExactSolution flight = exact_solution(flying, std::vector<MaterialPoint>{{1.9, 0.3}});
  CHECK(flight.fields.displacement[0] == Approx(1.9).epsilon(1e-13));
}

TEST_CASE("a free body that stretches at a uniform rate does so until the fronts come", "[exact]") {
  const Scene scene =
      body("linear", free_free, "[initial.velocity]\nshape = \"linear\"\namplitude = 0.2\ngradient = 0.1\n");
  const ExactSolution exact = exact_solution(scene, std::vector<MaterialPoint>{{0.03, 0.5}, {0.03, 0.6}});
  // v = 0.2 m/s + 0.1/s X; the strain is 0.003.
  CHECK(exact.fields.displacement[0] == Approx(0.03 * 0.25).epsilon(1e-13));
  CHECK(exact.fields.velocity[1] == Approx(0.26).epsilon(1e-13));
  CHECK(exact.fields.stress[0] == Approx(300.0).epsilon(1e-12));
}

TEST_CASE("travelling waves agree with the method of lines where it converges", "[exact]") {
  const Scene scene = body("linear", "ends = { left = \"free\", right = \"fixed\" }",
                           "[initial.velocity]\nshape = \"sine\"\namplitude = 0.2\nmode = 2\n"
                           "[initial.displacement]\nshape = \"sine\"\namplitude = 0.001\n" +
                               gravity);
  const std::vector<double> X{0.0, 0.2, 0.4, 0.6, 0.8, 1.0};
  const auto lines = method_of_lines(scene, *loads_of(scene), {384, 4, 1.0})(0.27, X);
  std::vector<MaterialPoint> points;
  for (const double x : X) points.push_back({0.27, x});
  const auto exact = exact_solution(scene, points).fields;
  // Kinks leave errors of the second order of the elements' size in what is of size 0.02 m and 0.3 m/s.
  CHECK(largest_difference(exact.displacement, lines.displacement) < 1e-6);
  CHECK(largest_difference(exact.velocity, lines.velocity) < 1e-3);
}

TEST_CASE("the kink of the column: its place, and the slopes of both sides", "[exact]") {
  const double b = -9.81;
  for (const char* variant : {"small", "large"}) {
    const Scene scene = built_in("column", variant);
    const double c = std::sqrt(scene.material.youngs_modulus / scene.material.density);
    const double time = 0.4 * scene.body.length / c;
    const auto exact = exact_solution(scene, std::vector<MaterialPoint>{{time, 0.0}});
    REQUIRE(exact.breaks);
    REQUIRE(exact.breaks->size() == 2);  // of velocity and stress
    const FieldBreak& velocity = exact.breaks->front();
    CHECK(velocity.field == "velocity");
    CHECK_FALSE(velocity.is_jump);
    // Ahead of it the body falls freely. Behind it is a simple wave: v = b (t - s), X = c exp(-b s/c) (t - s)
    // for the curve that left the base at s.
    const double slope = b / (c + b * time);
    CHECK(velocity.X == Approx(0.4 * scene.body.length).epsilon(1e-12));
    CHECK(velocity.left == Approx(slope).epsilon(1e-6));
    CHECK(std::abs(velocity.right) < 1e-6 * std::abs(b / c));
    CHECK(exact.breaks->back().left == Approx(-scene.material.density * c * slope).epsilon(1e-6));
  }
}

TEST_CASE("the kink of the column of large strains moves with the waves, and on after each reflection",
          "[exact]") {
  const Scene scene = built_in("column", "large");
  const auto reference = make_reference(scene);
  REQUIRE(reference);
  REQUIRE(reference->breaks);
  const double dt = 1e-5;
  for (const double time : {0.05, 0.15, 0.25, 0.37, 0.55, 1.0, 2.4}) {
    const double before = reference->breaks(time - dt).front();
    const double at = reference->breaks(time).front();
    const double after = reference->breaks(time + dt).front();
    // In the undeformed body waves have the speed c/λ; the error of the difference is (c/λ)″dt²/6.
    const double stretch = reference->at(time, std::vector{at}).stretch.front();
    CHECK(std::abs(after - before) / (2.0 * dt) == Approx(10.0 / stretch).epsilon(1e-5));
  }
}

TEST_CASE("seen from the other side and elsewhere the kinks are where they should be", "[exact]") {
  const Scene right = built_in("column", "large", {{"ends.left", "free"}, {"ends.right", "fixed"}});
  CHECK(make_reference(right)->breaks(0.04).front() == Approx(0.6).epsilon(1e-12));
  const Scene moved = built_in("column", "small", {{"body.start", "3.0"}});
  CHECK(make_reference(moved)->breaks(0.0).front() == 3.0);
}

TEST_CASE("the stretch of every reference is the slope of its positions", "[exact]") {
  const std::string sine = "[initial.displacement]\nshape = \"sine\"\namplitude = 0.002\n";
  const std::string ramped = "[[effect]]\ntype = \"traction\"\nvalue = 5000.0\nramp_time = 0.2\n";
  const std::string viscosity = "[[effect]]\ntype = \"viscosity\"\nviscosity = 300.0\n";
  std::vector<Scene> scenes{
      built_in("column", "small"),
      built_in("column", "large"),
      built_in("column", "settled"),
      built_in("bar", "small"),
      body("linear", fixed_fixed, sine),
      body("linear", fixed_free, pull + gravity),
      body("neo-hookean", fixed_free, ramped + viscosity),
      body("linear", fixed_free, ramped + viscosity),
      body("linear", fixed_fixed, sine + viscosity),
      body("linear", free_free, sine + viscosity),
      body("hencky", fixed_fixed, "[[effect]]\ntype = \"manufactured\"\namplitude = 0.01\n")};
  for (const Scene& scene : scenes) {
    const auto reference = make_reference(scene);
    REQUIRE(reference);
    INFO(reference->description);
    for (const double part : {0.01, 0.2}) {
      const double h = 1e-4 * scene.body.length;
      const double X = 0.37 * scene.body.length;
      const auto fields = reference->at(part * scene.end_time, std::vector{X - h, X, X + h});
      const double slope = (fields.displacement[2] - fields.displacement[0]) / (2.0 * h);
      // The difference has an error of h²/6 u‴ and, where elements are interpolated, that of their slope.
      CHECK(fields.stretch[1] - 1.0 == Approx(slope).margin(2e-6 + 2e-5 * std::abs(slope)));
    }
  }
  const Scene viscous = body("linear", fixed_fixed, sine + viscosity);
  const auto start = make_reference(viscous)->at(0.0, std::vector{0.25});
  CHECK(start.stress[0] == Approx(1e5 * (start.stretch[0] - 1.0)).epsilon(1e-12));
}

TEST_CASE("a manufactured solution obeys the equation of motion with its body force", "[exact]") {
  for (const char* law : {"rate", "hencky", "neo-hookean"}) {
    CAPTURE(law);
    const Scene scene = body(law, fixed_fixed, "[[effect]]\ntype = \"manufactured\"\namplitude = 0.05\n");
    for (const double X : {0.1, 0.45, 0.8}) {
      // ρ0 b = ρ0 ∂v/∂t − ∂σ/∂X by central differences, whose error is that of their third derivatives.
      constexpr double dt = 1e-5, dX = 1e-4, t = 0.03;
      const std::vector<MaterialPoint> points{{t, X}, {t - dt, X}, {t + dt, X}, {t, X - dX}, {t, X + dX}};
      const ExactSolution exact = exact_solution(scene, points);
      const auto& [v, s] = std::tie(exact.fields.velocity, exact.fields.stress);
      const double by_differences = (v[2] - v[1]) / (2.0 * dt) - (s[4] - s[3]) / (2.0 * dX) / 1000.0;
      CHECK(std::abs(exact.body_force[0] - by_differences) < 1e-5 * (10.0 + std::abs(exact.body_force[0])));
    }
  }
  CHECK(
      exact_solution(built_in("column", "large"), std::vector<MaterialPoint>{{0.1, 0.5}}).body_force.empty());
}

TEST_CASE("points in any order have the values they have in order, and errors of their own", "[exact]") {
  const Scene scene = built_in("column", "large");
  const std::vector<MaterialPoint> ordered{{0.1, 0.2}, {0.1, 0.7}, {0.4, 0.3}, {2.5, 0.0}, {2.5, 1.0}};
  const std::vector<std::size_t> order{3, 1, 4, 0, 2};
  std::vector<MaterialPoint> mixed;
  for (const std::size_t i : order) mixed.push_back(ordered[i]);
  const auto a = exact_solution(scene, ordered).fields;
  const auto b = exact_solution(scene, mixed).fields;
  for (const auto field : point_fields)
    for (std::size_t i = 0; i < order.size(); ++i) {
      CHECK((b.*field)[i] == (a.*field)[order[i]]);
      CHECK((b.error.*field)[i] == (a.error.*field)[order[i]]);
    }
  CHECK(a.displacement[3] == Approx(0.0).margin(1e-12));
  CHECK(*std::ranges::max_element(a.error.displacement) < 1e-9);
  CHECK(*std::ranges::max_element(a.error.displacement) > 0.0);
}

TEST_CASE("where there is no exact solution, the reason is told", "[exact]") {
  const auto said = [](const Scene& scene, MaterialPoint point) {
    return message_of<Error>([&] { exact_solution(scene, std::vector{point}); });
  };
  const Scene column = built_in("column", "large");
  CHECK(outside(column, {2.5, 1.0 + 1e-16}).empty());
  CHECK(contains(said(column, {0.1, 1.1}), "X = 1.1 m is not in the body, 0 to 1 m"));
  CHECK(contains(said(column, {3.0, 0.1}), "t = 3 s is not within the run, 0 to 2.5 s"));
  CHECK(contains(said(column, {-1.0, 0.1}), "t = -1 s is not within"));
  CHECK(contains(said(built_in("column", "settled"), {0.1, 0.1}), "is its state of rest"));
  CHECK(exact_solution(built_in("column", "settled"),
                       std::vector<MaterialPoint>{{built_in("column", "settled").end_time, 1.0}})
            .breaks->empty());
  const Scene damped = built_in("column", "large", {{"end_time", "0.1"}, {"material.law", "hencky"}});
  CHECK_FALSE(exact_solution(damped, std::vector<MaterialPoint>{{0.1, 0.5}}).breaks);
  Scene heavy = column;
  heavy.effects.front().parameters["acceleration"] = -90.0;
  CHECK(contains(said(heavy, {2.0, 0.5}),
                 "no exact solution at t = 2 s: no smooth reference solution exists beyond"));
  Scene locally = column;
  locally.effects.push_back({"local-damping", {{"coefficient", 0.1}}, {}});
  CHECK(said(locally, {0.1, 0.5}) == "scene: no reference solution is known for this scene");
}
