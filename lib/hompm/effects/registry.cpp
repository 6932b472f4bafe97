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

double viscous_time(const Scene& scene) {
  double sum = 0.0;
  for (const EffectSpec& spec : scene.effects)
    if (const auto time = find_effect(scene, spec).viscous_time; time != nullptr) sum += time(spec, scene);
  return sum;
}

double force_factor(const Scene& scene) {
  double product = 1.0;
  for (const EffectSpec& spec : scene.effects)
    if (const auto factor = find_effect(scene, spec).force_factor; factor != nullptr) product *= factor(spec);
  return product;
}

double damping_rate(const Scene& scene) {
  double sum = 0.0;
  for (const EffectSpec& spec : scene.effects)
    if (const auto rate = find_effect(scene, spec).damping_rate; rate != nullptr) sum += rate(spec);
  return sum;
}

}  // namespace hompm
