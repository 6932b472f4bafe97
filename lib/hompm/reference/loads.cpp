#include <hompm/reference/loads.hpp>

namespace hompm {

std::optional<Loads> loads_of(const Scene& scene) {
  Loads loads;
  for (const EffectSpec& effect : scene.effects) {
    if (effect.type == "gravity") {
      loads.gravity.push_back({effect.number("acceleration"), amplitude_of(effect)});
    } else if (effect.type == "mass-damping") {
      loads.damping_rate += effect.number("rate");
    } else if (effect.type == "viscosity") {
      loads.viscosity += effect.number("viscosity");
    } else if (effect.type == "local-damping") {
      loads.local_damping = true;
    } else if (effect.type == "traction") {
      const bool left = effect.text("end") == "left";
      (left ? loads.left : loads.right).push_back({effect.number("value"), amplitude_of(effect)});
    } else {
      return std::nullopt;
    }
  }
  return loads;
}

double total(const std::vector<Load>& loads, double time) {
  double sum = 0.0;
  for (const Load& load : loads) sum += load.value * load.amplitude(time);
  return sum;
}

std::optional<double> final_total(const std::vector<Load>& loads) {
  double sum = 0.0;
  for (const Load& load : loads) {
    const std::optional<double> factor = load.amplitude.final();
    if (!factor) return std::nullopt;
    sum += load.value * *factor;
  }
  return sum;
}

}  // namespace hompm
