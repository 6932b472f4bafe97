#include <hompm/effects/effects.hpp>
#include <hompm/effects/registry.hpp>

namespace hompm {

const std::vector<EffectType>& effect_catalogue() {
  static const std::vector<EffectType> catalogue{
      detail::gravity(),
      detail::traction(),
      detail::mass_damping(),
      detail::local_damping(),
  };
  return catalogue;
}

}  // namespace hompm
