#include <hompm/numerics/elementary.hpp>
#include <hompm/scene/scene.hpp>

namespace hompm {

double velocity_at(const InitialVelocity& initial, double place, double length) {
  if (initial.shape == "uniform") return initial.amplitude;
  if (initial.shape == "linear") return initial.amplitude + initial.gradient.value_or(0.0) * (place * length);
  return initial.amplitude * numerics::sin_pi(initial.mode * place);
}

std::vector<const Scene*> bodies_of(const Scene& scene) {
  if (scene.bodies.empty()) return {&scene};
  std::vector<const Scene*> all;
  for (const Scene& body : scene.bodies) all.push_back(&body);
  return all;
}

}  // namespace hompm
