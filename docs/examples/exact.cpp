// The exact solution of a built-in case at points and times of one's own.
// Prints:
//   column of large strains, method of characteristics (extrapolated net, 8th order)
//   t = 0.05 s, X = 0.25 m: displacement -0.00912046 m, velocity -0.239163 m/s, stress -2545.22 Pa
//   t = 0.05 s, X = 0.5 m: displacement -0.0122625 m, velocity -0.4905 m/s, stress 0 Pa
//   t = 0.05 s, X = 1 m: displacement -0.0122625 m, velocity -0.4905 m/s, stress 0 Pa
//   good to 7e-13 of the displacement
//   t = 0.1 s, X = 0.25 m: displacement -0.0207832 m, velocity -0.227448 m/s, stress -7826.71 Pa
//   t = 0.1 s, X = 0.5 m: displacement -0.0361663 m, velocity -0.465873 m/s, stress -5286.26 Pa
//   t = 0.1 s, X = 1 m: displacement -0.04905 m, velocity -0.981 m/s, stress 0 Pa
//   good to 9e-14 of the displacement
#include <cstdio>
#include <vector>

#include <hompm/kit/kit.hpp>

int main() {
  // 1. A scene; its key "end_time" says how far the reference solution must reach.
  const hompm::Scene scene = hompm::load_builtin("column", "large", {});
  const auto reference = hompm::make_reference(scene);
  if (!reference) return 1;
  std::printf("%s\n", reference->description.c_str());

  // 2. Points of the body and times, both ascending.
  const std::vector<double> X{0.25, 0.5, 1.0};
  for (const double time : {0.05, 0.1}) {
    const hompm::ReferenceFields fields = reference->at(time, X);
    for (std::size_t i = 0; i < X.size(); ++i)
      std::printf("t = %g s, X = %g m: displacement %.6g m, velocity %.6g m/s, stress %.6g Pa\n", time, X[i],
                  fields.displacement[i], fields.velocity[i], fields.stress[i]);
    std::printf("good to %.1g of the displacement\n", reference->estimated_error().displacement);
  }
}
