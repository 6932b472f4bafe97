#include <hompm/numerics/elementary.hpp>
#include <hompm/scene/scene.hpp>

namespace hompm {

double velocity_at(const InitialVelocity& initial, double place, double length) {
  if (initial.shape == "uniform") return initial.amplitude;
  if (initial.shape == "linear") return initial.amplitude + initial.gradient.value_or(0.0) * (place * length);
  return initial.amplitude * numerics::sin_pi(initial.mode * place);
}

}  // namespace hompm
