// step_scene SCENE STEPS [watched]: the steps of a scene and nothing else, or with all that a run watches,
// for counting instructions.
#include <iostream>
#include <string>

#include <hompm/error.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/simulation/run.hpp>

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) return 2;
  try {
    hompm::Scene scene = hompm::load_scene(argv[1], {});
    const double time_step = scene.scheme.time_step.value();
    const int steps = std::stoi(argv[2]);
    if (argc == 4) {
      scene.end_time = steps * time_step;
      hompm::run(scene, {.time_step = time_step, .steps = steps, .critical_time_step = 2.0 * time_step});
      return 0;
    }
    hompm::Simulation simulation(scene, time_step);
    for (int i = 0; i < steps; ++i) simulation.step();
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
