// Fields and stages that declare themselves: what a plan is checked for, and what a simulation is as a value.
#include <string>
#include <thread>

#include <hompm/effects/registry.hpp>
#include <hompm/error.hpp>
#include <hompm/plan/plan.hpp>
#include <hompm/scheme/scheme.hpp>
#include <hompm/simulation/simulation.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/recorded_run.hpp"
#include "support/scenes.hpp"

namespace {

using namespace hompm::test;
using hompm::Field;
using hompm::Phase;
using hompm::Plan;
using hompm::Simulation;
using hompm::StageBuilder;
using hompm::State;
using hompm::operator""_field;

/// A state, and a plan that is made by hand.
struct Made {
  hompm::Scene scene = free_body();
  State state = hompm::initial_state(scene);
  Plan plan = {};

  [[nodiscard]] StageBuilder builder() { return {scene, scene.scheme, state, plan, "the test"}; }
  void stage(const std::string& name, Phase phase, hompm::Fields reads, hompm::Fields changes,
             hompm::Fields writes) {
    builder().add({name, phase, std::move(reads), std::move(changes), std::move(writes), [](State&) {}});
  }
  [[nodiscard]] std::string fault() const {
    return message_of<hompm::Error>([&] { hompm::check_plan(plan, state); });
  }
};

constexpr Field force = "grid.force"_field, velocity = "particles.velocity"_field;

}  // namespace

TEST_CASE("a plan in which a stage reads what no stage writes is refused") {
  Made made;
  made.stage("push", Phase::acceleration, {force}, {}, {});
  CHECK(made.fault() == "the stage \"push\" reads grid.force, which no stage writes");
  Made changed;
  changed.stage("pull", Phase::acceleration, {}, {force}, {});
  CHECK(changed.fault() == "the stage \"pull\" reads grid.force, which no stage writes");
  Made kept;  // kept from step to step, but never made
  kept.stage("damp", Phase::acceleration, {"grid.momentum"_field}, {}, {});
  CHECK(kept.fault() == "the stage \"damp\" reads grid.momentum, which no stage writes");
}

TEST_CASE("a plan in which a stage reads before another writes is refused, both by name") {
  Made made;
  made.stage("push", Phase::geometry, {force}, {}, {});
  made.stage("make force", Phase::internal_force, {}, {}, {force});
  CHECK(made.fault() == "the stage \"push\" reads grid.force before the stage \"make force\" writes it");
  Made scratch;
  const Field own = scratch.builder().field({"own", "m", "of the test"});
  scratch.stage("use", Phase::work, {own}, {}, {});
  scratch.stage("make", Phase::motion, {}, {}, {own});
  CHECK(scratch.fault() == "the stage \"use\" reads particles.own before the stage \"make\" writes it");
  Made kept;  // of the last step
  const Field memory =
      kept.builder().field({.name = "memory", .unit = "m", .meaning = "", .persists = true}, 2.0);
  kept.stage("use", Phase::work, {memory}, {}, {});
  kept.stage("make", Phase::motion, {}, {}, {memory});
  CHECK(kept.fault().empty());
  CHECK(kept.state[memory] == std::vector<double>(kept.state.particles.size(), 2.0));
}

TEST_CASE("a plan in which a stage overwrites what nothing has read is refused, both by name") {
  Made made;
  made.stage("first", Phase::geometry, {}, {}, {force});
  made.stage("second", Phase::work, {}, {}, {force});
  CHECK(made.fault() ==
        "the stage \"second\" overwrites grid.force, which the stage \"first\" has written and no stage has "
        "read");
  Made read;
  read.stage("first", Phase::geometry, {}, {}, {force});
  read.stage("between", Phase::acceleration, {force}, {velocity}, {});
  read.stage("second", Phase::work, {}, {}, {force});
  CHECK(read.fault().empty());
}

TEST_CASE("a field of another plan is refused") {
  Made made;
  made.stage("lost", Phase::work, {Field{1000}}, {}, {});
  CHECK(made.fault() == "a field that its plan has not declared");
}

TEST_CASE("names of fields are told apart, and found") {
  Made made;
  const auto builder = made.builder();
  using hompm::Site;
  const Field a = builder.field({"own", "m", "", Site::function}),
              b = builder.field({"own", "m", "", Site::function});
  const Field one = builder.field({"own", "m", "", Site::body});
  const Field many = builder.field({"own", "m", "", Site::particle_function});
  CHECK(info_of(made.state, a).name == "grid.own");
  CHECK(info_of(made.state, b).name == "grid.own_2");
  CHECK(made.state.find("grid.own_2") == &made.state[b]);
  CHECK(made.state[one].size() == 1);
  CHECK(made.state[many].size() == made.state.basis.values.size());
  CHECK(made.state[velocity].data() == made.state.particles.velocity.data());
  CHECK(made.state.find("grid.none") == nullptr);
}

TEST_CASE("a simulation is a value: a copy goes its own way, and the same way") {
  const auto& scheme = GENERATE(from_range(hompm::scheme_table()));
  const std::string integrator = GENERATE("euler-cromer", "leapfrog");
  const auto scene = busy_scene(scheme.name, scheme.default_degree, integrator, "finite");
  CAPTURE(scheme.name, integrator);
  Simulation one(scene, 1e-3);
  for (int step = 0; step < 5; ++step) one.step();
  Simulation two = one;
  CHECK(one == two);
  const auto before = one;
  const auto row = two.history(0.0);
  (void)two.snapshot(0.0);
  CHECK(two == before);  // outputs write nothing
  CHECK(two.history(0.0).residual == row.residual);
  two.step();
  CHECK_FALSE(one == two);
  one.step();
  CHECK(one == two);
}

TEST_CASE("copies are stepped by two threads at once, and the original is read by both") {
  const auto scene = busy_scene("high-order", 3, "leapfrog", "finite");
  Simulation first(scene, 1e-3);
  first.step();
  const Simulation& shared = first;
  Simulation copies[] = {first, first};
  double residuals[2] = {};
  {
    std::thread threads[2];
    for (int k = 0; k < 2; ++k)
      threads[k] = std::thread([&, k] {
        for (int step = 0; step < 20; ++step) {
          copies[k].step();
          residuals[k] += shared.history(0.0).residual + shared.snapshot(0.0).stress.front();
        }
      });
    for (auto& thread : threads) thread.join();
  }
  CHECK(copies[0] == copies[1]);
  CHECK(residuals[0] == residuals[1]);
}

TEST_CASE(
    "the length of a step is an argument; equal ones are those of one length, and the time is rounded once") {
  const std::string integrator = GENERATE("euler-cromer", "leapfrog", "blanes-moan");
  const auto scene = busy_scene("high-order", 3, integrator, "finite");
  Simulation one(scene, 1e-3), two(scene, 1.0);
  for (int step = 1; step <= 300; ++step) {
    one.step();
    two.step(1e-3);
    CHECK(two.state().time == step * 1e-3);
  }
  CHECK(one == two);
}

TEST_CASE(
    "steps of changing length keep the order of leapfrog: the kick left over is that of the last step") {
  // A bar that vibrates: displacement after a quarter of a period, by steps of two lengths by turns.
  const auto error = [](int pairs) {
    const auto scene = hompm::parse_scene(R"(
end_time = 1
body.length = 1
material = { law = "linear", density = 1, youngs_modulus = 1 }
initial.velocity = { shape = "sine", amplitude = 0.1 }
scheme = { name = "high-order", cells = 8, particles_per_cell = 3, degree = 4, time_step = 1e-3, time_integrator = "leapfrog", relaxation_rate = 0 }
)",
                                          "changing steps", {});
    const double length = 0.25 / pairs;
    Simulation simulation(scene, length);
    for (int pair = 0; pair < pairs; ++pair) {
      simulation.step(0.6 * length);
      simulation.step(0.4 * length);
    }
    const auto now = simulation.snapshot(0.25);
    const double pi = 3.141592653589793;
    const std::size_t i = now.size() / 2;
    return std::abs(now.velocity[i] - 0.1 * std::cos(0.25 * pi) * std::sin(pi * now.reference_position[i]));
  };
  const double coarse = error(8), fine = error(16);
  CHECK(coarse / fine > 3.5);  // second order: 4
}
