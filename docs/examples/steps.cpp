// A simulation stepped by hand, reading fields between steps: the largest tension of the first hundred steps.
// Prints:
//   largest tension so far 0.0125642 Pa
//   the copy of the start is as it was
#include <iostream>

#include <hompm/kit/kit.hpp>

int main() {
  // 1. The scene of a built-in case with other values, as --set has them.
  const hompm::Scene scene = hompm::load_builtin("bar", "small", {{"scheme.name", "high-order", "here"}});
  const hompm::TimeStepping stepping = hompm::time_stepping(scene);

  // 2. A simulation is a value: it can be copied, compared, and its copies go on by themselves.
  hompm::Simulation simulation(scene, stepping.time_step);
  const hompm::Simulation start = simulation;

  // 3. Steps, their length an argument; velocities in `snapshot` are those at the time of the positions.
  double largest = 0.0;
  for (int step = 1; step <= 100; ++step) {
    simulation.step(stepping.time_step);
    const hompm::Snapshot now = simulation.snapshot(step * stepping.time_step);
    for (const double stress : now.stress) largest = std::max(largest, stress);
  }
  std::cout << "largest tension so far " << largest << " Pa\n"
            << (simulation == start ? "nothing moved\n" : "the copy of the start is as it was\n");
}
