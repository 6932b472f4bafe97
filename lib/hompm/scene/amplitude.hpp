// How a load changes with time.
#pragma once

#include <optional>

#include <hompm/scene/scene.hpp>

namespace hompm {

/// The factor of a load at a time t (s): sin(2π f t) · s(t/T) · s((D − t)/T), s the smooth step. Each part is
/// there only where its parameter is: a load without any is constant from t = 0.
struct Amplitude {
  double ramp_time = 0.0;  ///< T, s; 0: at once
  double frequency = 0.0;  ///< f, Hz; 0: no oscillation
  double duration = 0.0;   ///< D, s, until the load is gone, smoothly over the last T; 0: it stays

  [[nodiscard]] double operator()(double time) const;
  [[nodiscard]] bool constant() const { return ramp_time == 0.0 && frequency == 0.0 && duration == 0.0; }
  /// Begins and ends without a jump: with four continuous derivatives.
  [[nodiscard]] bool smooth() const { return ramp_time > 0.0; }
  /// What is left in the end; nothing where the load oscillates for ever.
  [[nodiscard]] std::optional<double> final() const;
  /// From when on it no longer changes, s; infinite where the load oscillates for ever.
  [[nodiscard]] double settled_from() const;
};

/// That of an effect by its parameters ramp_time, frequency, duration; 0 where it has none of that name.
Amplitude amplitude_of(const EffectSpec& spec);

}  // namespace hompm
