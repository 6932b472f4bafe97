// The parameters of every load that may change with time.
#pragma once

#include <iterator>
#include <utility>
#include <vector>

#include <hompm/effects/registry.hpp>

namespace hompm::detail {

/// `own`, then those that `amplitude_of` reads.
inline std::vector<EffectParameter> with_amplitude(std::vector<EffectParameter> own) {
  std::vector<EffectParameter> shape{
      {.name = "ramp_time",
       .unit = "s",
       .meaning = "until it acts in full, with four continuous derivatives; 0: at once",
       .minimum = 0.0,
       .default_value = 0.0},
      {.name = "frequency",
       .unit = "Hz",
       .meaning = "factor sin(2 pi frequency t); 0: none",
       .minimum = 0.0,
       .default_value = 0.0},
      {.name = "duration",
       .unit = "s",
       .meaning = "after which it is gone, smoothly over the last ramp_time; 0: it stays",
       .minimum = 0.0,
       .default_value = 0.0}};
  std::move(shape.begin(), shape.end(), std::back_inserter(own));
  return own;
}

}  // namespace hompm::detail
