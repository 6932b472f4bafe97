// What the schemes of the family promise: their bases, transfers and sequences of updates.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/scheme/particle_domains.hpp>
#include <hompm/scheme/scheme.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/scenes.hpp"

namespace {

using hompm::Phase;
using hompm::Simulation;
using hompm::State;
using hompm::test::built_in;
using hompm::test::contains;
using hompm::test::free_body;
using hompm::test::message_of;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
const std::vector<std::string> of_hats{"ugimp", "cpgimp", "cpdi", "ddmp"};

/// Moves all particles, and the ends of their domains, by x → x + shift(x).
template <class Shift>
void move_particles(Simulation& simulation, Shift shift) {
  State& state = simulation.state();
  hompm::Particles& p = state.particles;
  auto* right_end = state.find("particles.right_end");
  double left = shift(0.0);
  state.left_boundary = left;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double end = p.reference_position[i] + 0.5 * p.reference_volume[i];
    const double right = end + shift(end);
    p.position[i] = 0.5 * (left + right);
    p.volume[i] = right - left;
    if (right_end != nullptr) (*right_end)[i] = right;
    left = right;
  }
  simulation.plan().run(Phase::geometry, state);
}

double uneven(double x) { return 0.02 * std::sin(25.0 * x) + 0.013; }

double at(const State& state, const std::vector<double>& weights, std::size_t p,
          const std::vector<double>& field) {
  double sum = 0.0;
  for (std::size_t k = 0; k < state.basis.stencil; ++k)
    sum += weights[p * state.basis.stencil + k] * field[static_cast<std::size_t>(state.basis.first[p]) + k];
  return sum;
}

}  // namespace

TEST_CASE("the functions of particle domains are a partition of unity and reproduce linear fields") {
  const std::string scheme = GENERATE(from_range(of_hats));
  Simulation simulation(free_body({{"scheme.name", scheme}}), 1e-3);
  move_particles(simulation, uneven);
  const State& state = simulation.state();
  std::vector<double> node, one(state.fields.mass.size(), 1.0);
  for (int i = 0; i < state.grid.functions(); ++i) node.push_back(state.grid.breakpoint(i));
  const auto& p = state.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    CHECK(std::abs(at(state, state.basis.values, i, one) - 1.0) <= 4 * epsilon);
    CHECK(std::abs(at(state, state.basis.gradients, i, one)) <=
          16 * 8 * epsilon);  // of gradients of 1/h = 16
    CHECK(std::abs(at(state, state.basis.values, i, node) - p.position[i]) <= 8 * epsilon);
    CHECK(std::abs(at(state, state.basis.gradients, i, node) - 1.0) <= 32 * epsilon);
  }
}

TEST_CASE("the values of a domain are means of the hat functions over it") {
  Simulation simulation(free_body({{"scheme.name", "cpgimp"}}), 1e-3);
  move_particles(simulation, uneven);
  const State& state = simulation.state();
  const auto& p = state.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t k = 0; k < state.basis.stencil; ++k) {
      const double node = state.grid.breakpoint(state.basis.first[i] + static_cast<int>(k));
      // Midpoints of 1000 parts: exact but for the parts with a kink, of an error of 1e-3² each.
      double mean = 0.0;
      for (int part = 0; part < 1000; ++part) {
        const double x = p.position[i] + p.volume[i] * ((part + 0.5) / 1000.0 - 0.5);
        mean += std::max(0.0, 1.0 - std::abs(x - node) / state.grid.cell_width()) / 1000.0;
      }
      CHECK(std::abs(state.basis.values[4 * i + k] - mean) < 1e-6);
    }
  }
}

TEST_CASE("the force has no jump where a particle crosses a cell, but with plain hat functions") {
  // Of one particle with stress 1, just left and just right of a node.
  const auto jump = [](const std::string& scheme) {
    Simulation simulation(free_body({{"scheme.name", scheme}}), 1e-3);
    State& state = simulation.state();
    hompm::Particles& p = state.particles;
    const std::size_t particle = 30;
    p.stress[particle] = 1.0;
    const double to_node = 0.5 - p.reference_position[particle];
    const auto force = [&](double beside) {
      move_particles(simulation, [&](double) { return to_node + beside; });
      simulation.plan().run(Phase::total_stress, state);
      simulation.plan().run(Phase::internal_force, state);
      return state.fields.internal_force;
    };
    const auto left = force(-1e-9);
    const auto right = force(1e-9);
    double largest = 0.0;
    for (std::size_t i = 0; i < left.size(); ++i) largest = std::max(largest, std::abs(right[i] - left[i]));
    return largest / p.volume[particle];  // of gradients, which are 16 at most
  };
  CHECK(jump("classical") > 15.0);
  auto smooth = of_hats;
  smooth.insert(smooth.end(), {"bspline", "apic", "total-lagrangian"});
  for (const std::string& scheme : smooth) {
    INFO(scheme);
    CHECK(jump(scheme) < 1e-4);  // 2e-9 times the slope of a gradient, at most 2·16/(the domain, 1/64)
  }
}

TEST_CASE("a constant stress over domains without gaps gives no force inside") {
  const auto largest_inner_force = [](const std::string& scheme) {
    Simulation simulation(free_body({{"scheme.name", scheme}}), 1e-3);
    State& state = simulation.state();
    move_particles(simulation, uneven);
    std::fill(state.particles.stress.begin(), state.particles.stress.end(), 7.0);
    simulation.plan().run(Phase::total_stress, state);
    simulation.plan().run(Phase::internal_force, state);
    const auto& f = state.fields.internal_force;
    double largest = 0.0;
    for (std::size_t i = 8; i + 8 < f.size(); ++i) largest = std::max(largest, std::abs(f[i]));
    return largest;
  };
  for (const std::string scheme : {"cpgimp", "cpdi"})
    CHECK(largest_inner_force(scheme) <= 7.0 * 32 * epsilon);
  for (const std::string scheme : {"classical", "ugimp", "ddmp"}) {
    INFO(scheme);
    CHECK(largest_inner_force(scheme) > 1e-3);
  }
}

TEST_CASE(
    "the basis of a total Lagrangian scheme stays where it is, and so does a patch of constant stress") {
  const auto scene = built_in("bar", "large", {{"scheme.name", "total-lagrangian"}, {"end_time", "0.5"}});
  Simulation simulation(scene, 1e-3);
  const auto before = simulation.state().basis.values;
  for (int step = 0; step < 500; ++step) simulation.step();
  State& state = simulation.state();
  CHECK(state.basis.values == before);
  CHECK(std::abs(state.particles.displacement[state.particles.size() / 2]) > scene.body.length / 64);
  std::fill(state.particles.stress.begin(), state.particles.stress.end(), 7.0);
  simulation.plan().run(Phase::total_stress, state);
  simulation.plan().run(Phase::internal_force, state);
  const auto& f = state.fields.internal_force;
  // Particles of equal volumes at the middle of as many parts of a cell integrate linear gradients exactly.
  for (std::size_t i = 2; i + 2 < f.size(); ++i) CHECK(std::abs(f[i]) <= 7.0 * 64 * epsilon);
}

TEST_CASE("a uniform extension to ten times the length leaves no gap for carried and stretched domains") {
  const std::string scheme = GENERATE("cpgimp", "cpdi", "total-lagrangian");
  Simulation simulation(free_body({{"scheme.name", scheme},
                                   {"scheme.cells", "8"},
                                   {"scheme.particles_per_cell", "16"},
                                   {"scheme.margin_cells", "100"}}),
                        1e-3);
  auto& p = simulation.state().particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    p.velocity[i] = p.reference_position[i];
  }
  for (double& m : p.mass) m *= 1e12;  // so heavy that no stress slows it down
  simulation.plan().run(Phase::geometry, simulation.state());
  for (int step = 0; step < 9000; ++step) simulation.step();
  // Lumped projections smear the velocity in the cells at the ends.
  for (std::size_t i = p.size() / 4; i < 3 * p.size() / 4; ++i) CHECK(std::abs(p.stretch[i] - 10.0) < 1e-2);
  for (std::size_t i = 0; i + 1 < p.size(); ++i)
    CHECK(std::abs(p.position[i + 1] - p.position[i] - 0.5 * (p.volume[i] + p.volume[i + 1])) < 1e-3);
}

namespace {

/// Particle velocities after one step without forces.
std::vector<double> after_transfer(const std::string& scheme, const std::string& transfer,
                                   double flip_fraction, int xpic_order, const std::vector<double>& velocity,
                                   double slope = 0.0, const std::string& degree = "2") {
  hompm::Scene scene = free_body({{"scheme.name", scheme}, {"scheme.degree", degree}});
  auto& choices = scene.scheme.choices;
  if (transfer == "pic") choices.transfer = hompm::Transfer::pic;
  if (transfer == "xpic") choices.transfer = hompm::Transfer::xpic;
  choices.flip_fraction = flip_fraction;
  choices.xpic_order = xpic_order;
  Simulation simulation(scene, 1e-3);
  auto& p = simulation.state().particles;
  p.velocity = velocity;
  if (auto* gradient = simulation.state().find("particles.velocity_gradient"))
    std::fill(gradient->begin(), gradient->end(), slope);
  simulation.step();
  return p.velocity;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

std::vector<double> linear_velocity(double slope) {
  std::vector<double> v;
  for (int i = 0; i < 64; ++i) v.push_back(0.5 + slope * (i + 0.5) / 64.0);
  return v;
}

}  // namespace

TEST_CASE("APIC keeps a linear velocity field, PIC smears it at the ends") {
  const std::string degree = GENERATE("1", "2", "3");
  const auto linear = linear_velocity(2.0);
  CHECK(largest_difference(after_transfer("apic", "", 1.0, 2, linear, 2.0, degree), linear) <= 64 * epsilon);
  CHECK(largest_difference(after_transfer("bspline", "pic", 1.0, 2, linear), linear) > 1e-2);
}

TEST_CASE("FLIP mixed with PIC lies between both, XPIC of order 1 is PIC") {
  std::vector<double> rough;
  for (int i = 0; i < 64; ++i) rough.push_back(std::sin(0.3 * i) + (i % 2 == 0 ? 0.1 : -0.1));
  const auto flip = after_transfer("bspline", "flip", 1.0, 2, rough);
  const auto pic = after_transfer("bspline", "pic", 1.0, 2, rough);
  const auto half = after_transfer("bspline", "flip", 0.25, 2, rough);
  CHECK(flip == rough);
  for (std::size_t i = 0; i < rough.size(); ++i)
    CHECK(std::abs(half[i] - (0.25 * flip[i] + 0.75 * pic[i])) <= 4 * epsilon);
  CHECK(largest_difference(after_transfer("bspline", "flip", 0.0, 2, rough), pic) <= 4 * epsilon);
  CHECK(largest_difference(after_transfer("bspline", "xpic", 1.0, 1, rough), pic) <= 4 * epsilon);
}

TEST_CASE(
    "XPIC takes noise that the grid does not see, and leaves a smooth field the better the higher its "
    "order") {
  std::vector<double> smooth, noise;
  for (int i = 0; i < 64; ++i) {
    smooth.push_back(std::sin(2.0 * (i + 0.5) / 64.0));
    noise.push_back(i % 2 == 0 ? 0.1 : -0.1);
  }
  double before = 1.0;
  for (const int order : {1, 2, 4, 8}) {
    const double lost = largest_difference(after_transfer("bspline", "xpic", 1.0, order, smooth), smooth);
    CHECK(lost < 0.9 * before);
    before = lost;
    const auto left = after_transfer("bspline", "xpic", 1.0, order, noise);
    for (std::size_t i = 16; i < 48; ++i) CHECK(std::abs(left[i]) < 1e-3);
  }
}

TEST_CASE("transfers keep the momentum, and book what they take of the energy") {
  const std::string transfer = GENERATE("pic", "xpic", "mixed", "apic");
  std::vector<hompm::Override> overrides;
  const auto set = [&](const std::string& key, const std::string& value) {
    overrides.push_back({key, value, "--set " + key});
  };
  set("scheme.name", transfer == "apic" ? "apic" : "bspline");
  if (transfer == "mixed")
    set("scheme.flip_fraction", "0.9");
  else
    set("scheme.transfer", transfer);
  set("scheme.cells", "16");
  set("end_time", "1");
  const auto scene = hompm::load_builtin("bar", "large", overrides);
  const auto result = hompm::run(scene, hompm::time_stepping(scene));
  CHECK(result.largest_momentum_residual <= 1e-12 * result.largest_momentum);
  CHECK(result.end.dissipated > 0.0);
  CHECK(result.largest_residual < 1e-2 * result.start.kinetic);  // Euler-Cromer: first order in the step
}

TEST_CASE("the sequences of updates part by a first-order difference that vanishes with the step") {
  const std::string sequence = GENERATE("usl", "usf");
  const std::string scheme = GENERATE("bspline", "tielen2017");
  const auto displacements = [&](const std::string& order, const std::string& step) {
    const auto scene = built_in("bar", "large",
                                {{"scheme.name", scheme},
                                 {"scheme.sequence", order},
                                 {"scheme.cells", "16"},
                                 {"scheme.time_step", step},
                                 {"end_time", "0.5"}});
    Simulation simulation(scene, *scene.scheme.time_step);
    const int steps = static_cast<int>(0.5 / *scene.scheme.time_step + 0.5);
    for (int k = 0; k < steps; ++k) simulation.step();
    return simulation.state().particles.displacement;
  };
  const double coarse = largest_difference(displacements(sequence, "0.01"), displacements("musl", "0.01"));
  const double fine = largest_difference(displacements(sequence, "0.0025"), displacements("musl", "0.0025"));
  CHECK(coarse > 1e-9);
  CHECK(fine < 0.35 * coarse);
}

TEST_CASE("USF keeps the energy of long vibrations better than USL, which damps") {
  const auto lost = [](const std::string& sequence) {
    const auto scene = built_in("bar", "small",
                                {{"scheme.name", "bspline"},
                                 {"scheme.sequence", sequence},
                                 {"scheme.cells", "8"},
                                 {"scheme.time_step", "0.05"},
                                 {"end_time", "100"}});
    const auto result = hompm::run(scene, hompm::time_stepping(scene));
    return 1.0 - (result.end.kinetic + result.end.stored) / result.start.kinetic;
  };
  CHECK(lost("usl") > 0.05);
  CHECK(std::abs(lost("usf")) < 0.05);
}

TEST_CASE("domains end with the grid at fixed ends, whatever its cells round to") {
  const std::string scheme = GENERATE(from_range(of_hats));
  for (int cells = 3; cells < 60; ++cells) {
    const std::string length = std::to_string(0.1 * cells + 0.7);
    const auto scene = free_body({{"scheme.name", scheme},
                                  {"scheme.cells", std::to_string(cells)},
                                  {"scheme.particles_per_cell", "3"},
                                  {"body.length", length},
                                  {"body.start", "0.1"},
                                  {"ends.left", "fixed"},
                                  {"ends.right", "fixed"}});
    Simulation simulation(scene, 1e-3);
    auto& p = simulation.state().particles;
    for (double& x : p.position) x += 1e-9;  // so that the last domain reaches beyond the end
    if (auto* ends = simulation.state().find("particles.right_end"))
      for (double& end : *ends) end += 1e-9;
    simulation.plan().run(Phase::geometry, simulation.state());
    const auto& mass = simulation.state().fields.mass;
    CHECK(std::abs(std::accumulate(mass.begin(), mass.end(), 0.0) - simulation.state().total_mass) <=
          512 * epsilon * simulation.state().total_mass);
  }
}

TEST_CASE("a domain too wide for its functions, and particles outside the grid, stop the run") {
  Simulation wide(free_body({{"scheme.name", "cpgimp"}, {"scheme.particles_per_cell", "1"}}), 1e-3);
  wide.state().particles.volume[5] *= 4.0;
  const auto geometry = [](Simulation& simulation) {
    return message_of<hompm::InvalidRun>([&] { simulation.plan().run(Phase::geometry, simulation.state()); });
  };
  CHECK(contains(geometry(wide), "particle 5: its domain of 0.25 m reaches over four cells of 0.0625 m"));
  for (const std::string& scheme : of_hats) {
    INFO(scheme);
    Simulation lost(free_body({{"scheme.name", scheme}}), 1e-3);
    lost.state().particles.position[7] = 100.0;
    if (scheme == "cpdi")
      (*lost.state().find("particles.right_end"))[7] = std::numeric_limits<double>::quiet_NaN();
    CHECK(contains(geometry(lost), "particle 7: left the grid"));
  }
  Simulation free(free_body({{"scheme.name", "cpdi"}}), 1e-3);
  free.state().find("particles.right_end")->back() = 100.0;
  CHECK(contains(geometry(free), "the free end left the grid"));
}

TEST_CASE("a body that starts displaced moves the same with the basis on either configuration") {
  const std::string scheme = GENERATE("bspline", "tielen2017", "cpgimp", "mixed");
  const auto displacements = [&](const std::string& formulation) {
    const auto scene = built_in("bar", "large",
                                {{"scheme.name", scheme},
                                 {"scheme.formulation", formulation},
                                 {"initial.displacement.shape", "sine"},
                                 {"initial.displacement.amplitude", "0.5"},
                                 {"end_time", "1"}});
    Simulation simulation(scene, 1e-3);
    for (int step = 0; step < 1000; ++step) simulation.step();
    return simulation.state().particles.displacement;
  };
  // Both are off by the error of 64 cells; at the displaced position the total Lagrangian one was off by 1.6
  // times the amplitude.
  CHECK(largest_difference(displacements("updated-lagrangian"), displacements("total-lagrangian")) < 0.02);
}

TEST_CASE("a transfer that damps leaves the velocity at the start as the scene says it") {
  for (const std::string scheme : {"bspline", "apic"}) {
    const auto damping = built_in("bar", "small",
                                  {{"scheme.name", scheme},
                                   {"scheme.cells", "8"},
                                   {"scheme.transfer", scheme == "apic" ? "apic" : "pic"}});
    CHECK(Simulation(damping, 1e-3).snapshot(0.0).velocity ==
          Simulation(built_in("bar", "small", {{"scheme.name", "classical"}, {"scheme.cells", "8"}}), 1e-3)
              .snapshot(0.0)
              .velocity);
  }
}

TEST_CASE("least squares of parabolas refuse a basis of higher degree, for those who set it by hand") {
  auto scene = built_in("bar", "small", {{"scheme.name", "mls"}});
  scene.scheme.degree = 4;
  CHECK(contains(message_of<hompm::Error>([&] { Simulation(scene, 1e-3); }),
                 "degree 2 with a basis of degree 4"));
}

TEST_CASE("update stress first takes the stress from the stretch, too") {
  const auto stresses = [](const std::string& update) {
    const auto scene = built_in("bar", "large",
                                {{"scheme.name", "bspline"},
                                 {"scheme.sequence", "usf"},
                                 {"scheme.stress_update", update},
                                 {"end_time", "0.5"}});
    Simulation simulation(scene, 1e-3);
    for (int step = 0; step < 500; ++step) simulation.step();
    return simulation.state().particles.stress;
  };
  const double difference = largest_difference(stresses("incremental"), stresses("from-stretch"));
  CHECK(difference > 0.0);
  CHECK(difference < 1e-2);  // of 10 Pa: the increments are of first order in the step
}
