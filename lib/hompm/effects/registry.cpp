#include <hompm/effects/effects.hpp>
#include <hompm/effects/registry.hpp>

namespace hompm {

const EffectCatalogue& effect_catalogue() {
  static const EffectCatalogue catalogue{
      detail::gravity(),         //
      detail::traction(),        //
      detail::mass_damping(),    //
      detail::local_damping(),   //
      detail::viscosity(),       //
      detail::bulk_viscosity(),  //
      detail::manufactured(),    //
      detail::plasticity(),      //
      detail::piston(),          //
      detail::wall(),            //
      detail::absorbing(),       //
      detail::contact(),         //
      detail::interface(),       //
  };
  return catalogue;
}

const EffectType& find_effect(const EffectSpec& spec) {
  for (const EffectType& type : effect_catalogue())
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
    if (const auto prepare = find_effect(spec).prepare; prepare != nullptr) prepare(spec, scene, state);
}

double viscous_time(const Scene& scene) {
  double sum = 0.0;
  for (const EffectSpec& spec : scene.effects)
    if (const auto time = find_effect(spec).viscous_time; time != nullptr) sum += time(spec, scene);
  return sum;
}

double damping_rate(const Scene& scene) {
  double sum = 0.0;
  for (const EffectSpec& spec : scene.effects)
    if (const auto rate = find_effect(spec).damping_rate; rate != nullptr) sum += rate(spec);
  return sum;
}

}  // namespace hompm
