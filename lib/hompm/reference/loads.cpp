#include <hompm/reference/loads.hpp>

namespace hompm {

std::optional<Loads> loads_of(const Scene& scene) {
  Loads loads;
  for (const EffectSpec& effect : scene.effects) {
    if (effect.type == "gravity") {
      loads.acceleration += effect.number("acceleration");
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

}  // namespace hompm
