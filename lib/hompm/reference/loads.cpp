#include <algorithm>

#include <hompm/numerics/smooth_step.hpp>
#include <hompm/reference/loads.hpp>

namespace hompm {

std::optional<Loads> loads_of(const Scene& scene) {
  Loads loads;
  for (const EffectSpec& effect : scene.effects) {
    if (effect.type == "gravity") {
      loads.gravity.push_back({effect.number("acceleration"), effect.number("ramp_time")});
    } else if (effect.type == "mass-damping") {
      loads.damping_rate += effect.number("rate");
    } else if (effect.type == "local-damping") {
      loads.local_damping = true;
    } else if (effect.type == "traction") {
      const bool left = effect.text("end") == "left";
      (left ? loads.left_stress : loads.right_stress) += effect.number("value");
    } else {
      return std::nullopt;
    }
  }
  return loads;
}

double Loads::acceleration(double time) const {
  double sum = 0.0;
  for (const BodyForce& force : gravity) sum += force.acceleration * numerics::ramp(time, force.ramp_time);
  return sum;
}

double Loads::full_acceleration() const {
  double sum = 0.0;
  for (const BodyForce& force : gravity) sum += force.acceleration;
  return sum;
}

bool Loads::ramped() const {
  return std::ranges::any_of(gravity, [](const BodyForce& force) { return force.ramp_time > 0.0; });
}

}  // namespace hompm
