#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <variant>

#include <hompm/materials/material.hpp>
#include <hompm/number.hpp>
#include <hompm/numerics/gauss_legendre.hpp>
#include <hompm/reference/static_equilibrium.hpp>

namespace hompm {
namespace {

template <class Law>
double stretch(const Law& law, double stress) {
  const double value = law.stretch(stress);
  if (!(value > 0.0 && value <= std::numeric_limits<double>::max()))
    throw Error("no equilibrium exists: the law cannot carry the stress " + to_text(stress) + " Pa");
  return value;
}

}  // namespace

ReferenceFields static_equilibrium(const Scene& scene, double acceleration, double pull,
                                   std::span<const double> X) {
  static const numerics::GaussRule rule = numerics::gauss_legendre(10);
  const double length = scene.body.length;
  const double weight = scene.material.density * acceleration;
  const double longest_panel = length / 64.0;
  const auto stress = [&](double x) { return pull + weight * (length - x); };

  ReferenceFields fields;
  const auto integrate = [&](const auto& law) {
    double displacement = 0.0;
    double from = 0.0;
    for (const double x : X) {
      const int panels = static_cast<int>(std::ceil((x - from) / longest_panel));
      for (int panel = 0; panel < panels; ++panel) {
        const double width = (x - from) / panels;
        double mean = 0.0;
        for (std::size_t g = 0; g < rule.points.size(); ++g) {
          mean += rule.weights[g] * (stretch(law, stress(from + (panel + rule.points[g]) * width)) - 1.0);
        }
        displacement += width * mean;
      }
      from = x;
      fields.displacement.push_back(displacement);
      fields.velocity.push_back(0.0);
      fields.stress.push_back(stress(x));
      fields.stretch.push_back(stretch(law, stress(x)));
    }
  };
  std::visit(integrate, make_material(scene.material));
  return fields;
}

}  // namespace hompm
