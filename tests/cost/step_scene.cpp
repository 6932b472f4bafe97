// step_scene SCENE STEPS: the steps of a scene and nothing else, for counting instructions.
#include <iostream>
#include <string>

#include <hompm/error.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/simulation/simulation.hpp>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    const hompm::Scene scene = hompm::load_scene(argv[1], {});
    hompm::Simulation simulation(scene, scene.scheme.time_step.value());
    const int steps = std::stoi(argv[2]);
    for (int i = 0; i < steps; ++i) simulation.step();
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
