// step_scene STEPS SCENE...: the steps of scenes and nothing else, for counting instructions. What refuses a
// scene, or nothing, goes to standard output, with a zero byte behind it.
// step_scene STEPS SCENE watched: one scene with all that a run watches.
#include <iostream>
#include <string>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/simulation/run.hpp>

/// callgrind writes what it has counted when this ends: --dump-after=scene_done.
extern "C" [[gnu::noinline]] void scene_done() { std::cout.put('\0').flush(); }

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const int steps = std::stoi(arguments[0]);
  if (arguments.back() == "watched") {
    hompm::Scene scene = hompm::load_scene(arguments[1], {});
    const double time_step = scene.scheme.time_step.value();
    scene.end_time = steps * time_step;
    hompm::run(scene, {.time_step = time_step, .steps = steps, .critical_time_step = 2.0 * time_step});
    return 0;
  }
  int refused = 0;
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    try {
      const hompm::Scene scene = hompm::load_scene(arguments[i], {});
      hompm::Simulation simulation(scene, scene.scheme.time_step.value());
      for (int step = 0; step < steps; ++step) simulation.step();
    } catch (const std::exception& error) {
      std::cout << error.what();
      ++refused;
    }
    scene_done();
  }
  return refused == 0 ? 0 : 1;
}
