#include <cmath>

#include <hompm/numerics/elementary.hpp>
#include <hompm/scene/scene.hpp>

namespace hompm {

double InitialField::at(double place, double length) const {
  if (shape == "uniform") return amplitude;
  if (shape == "linear") return amplitude + gradient.value_or(0.0) * (place * length);
  return amplitude * numerics::sin_pi(mode * place);
}

double InitialField::slope_at(double place, double length) const {
  if (shape == "uniform") return 0.0;
  if (shape == "linear") return gradient.value_or(0.0);
  return amplitude * (numerics::pi * mode / length) * numerics::cos_pi(mode * place);
}

double InitialField::steepest(double length) const { return std::abs(slope_at(0.0, length)); }

std::vector<const Scene*> bodies_of(const Scene& scene) {
  if (scene.bodies.empty()) return {&scene};
  std::vector<const Scene*> all;
  for (const Scene& body : scene.bodies) all.push_back(&body);
  return all;
}

}  // namespace hompm
