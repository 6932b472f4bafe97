#include <algorithm>
#include <cstdint>
#include <tuple>

#include <hompm/effects/registry.hpp>

namespace hompm {

const EffectCatalogue& effects_of(const Scene& scene) {
  return scene.effect_types != nullptr ? *scene.effect_types : effect_catalogue();
}

const EffectType& find_effect(const Scene& scene, const EffectSpec& spec) {
  for (const EffectType& type : effects_of(scene))
    if (type.name == spec.type) return type;
  throw SceneError(spec.origin, "there is no effect " + spec.type);
}

bool EffectType::holds(const EffectSpec& spec, const std::string& end, std::int64_t body,
                       std::int64_t count) const {
  if (!holds_end) return false;
  if (!couples())
    return spec.body.value_or(body) == body && spec.parameters.contains("end") && spec.text("end") == end;
  const std::int64_t left = end == "right" ? body : body - 1;  // of the pair that meets at this end
  return left >= 0 && left + 1 < count && spec.body.value_or(left) == left;
}

void prepare_effects(const Scene& scene, State& state) {
  for (const EffectSpec& spec : scene.effects)
    if (const auto prepare = find_effect(scene, spec).prepare; prepare != nullptr)
      prepare(spec, scene, state);
}

LoadOutlook outlook(const Scene& scene) {
  LoadOutlook sum;
  for (const EffectSpec& spec : scene.effects) {
    const auto of_effect = find_effect(scene, spec).outlook;
    if (of_effect == nullptr) continue;
    const LoadOutlook own = of_effect(spec, scene);
    sum.settled_from = std::max(sum.settled_from, own.settled_from);
    sum.energy += own.energy;
  }
  return sum;
}

void join_linear_ends(const Scene& scene, LinearEnd how, const PlanBuilder& builder) {
  for (const auto& [side, end, name] :
       {std::tuple{Side::left, scene.ends.left, "left"}, std::tuple{Side::right, scene.ends.right, "right"}})
    for (const EffectSpec& spec : scene.effects) {
      const EffectType& type = find_effect(scene, spec);
      if (end == End::fixed || type.join_linear == nullptr) continue;
      if (!type.couples() && spec.text("end") != name) continue;
      type.join_linear(side, how, builder);
      break;
    }
}

SmallMotion small_motion(const Scene& scene) {
  SmallMotion sum;
  for (const EffectSpec& spec : scene.effects) {
    const auto of_effect = find_effect(scene, spec).small_motion;
    if (of_effect == nullptr) continue;
    const SmallMotion own = of_effect(spec, scene);
    sum.viscous_time += own.viscous_time;
    sum.damping_rate += own.damping_rate;
    sum.force_factor *= own.force_factor;
  }
  return sum;
}

}  // namespace hompm
