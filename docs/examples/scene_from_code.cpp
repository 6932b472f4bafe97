// A scene from code, with the defaults and checks of a scene file, run and judged.
// Prints:
//   relative error of the stress 0.00256684
#include <iostream>

#include <hompm/kit/kit.hpp>

int main() try {
  // 1. Keys are those of a scene file (hompm-run --keys); what is left out has its default.
  const hompm::Scene scene = hompm::make_scene({{"end_time", 0.2},
                                                {"body.length", 1.0},
                                                {"material.law", "linear"},
                                                {"material.density", 1000.0},
                                                {"material.youngs_modulus", 1e5},
                                                {"ends.right", "free"},
                                                {"effect[0].type", "gravity"},
                                                {"effect[0].acceleration", -1.0},
                                                {"scheme.name", "high-order"},
                                                {"scheme.cells", 16},
                                                {"scheme.particles_per_cell", 2},
                                                {"scheme.step_fraction", 0.5}});

  // 2. The steps, and the error against the exact solution.
  const hompm::RunResult result = hompm::run(scene, hompm::time_stepping(scene));
  std::string reason;
  if (const auto errors = hompm::judge(scene, result, reason))
    std::cout << "relative error of the stress " << errors->stress.relative_l2 << '\n';
  else
    std::cout << "no error: " << reason << '\n';
} catch (const hompm::Error& error) {
  std::cerr << error.what() << '\n';  // "material.law: ...": the key, and what to write
  return 1;
}
