#include <limits>
#include <string>

#include <hompm/numerics/elementary.hpp>
#include <hompm/numerics/smooth_step.hpp>
#include <hompm/scene/amplitude.hpp>

namespace hompm {

double Amplitude::operator()(double time) const {
  double factor = numerics::ramp(time, ramp_time);
  if (frequency > 0.0) factor *= numerics::sin_pi(2.0 * frequency * time);
  if (duration > 0.0) {
    const double left = duration - time;
    factor = left > 0.0 ? factor * numerics::ramp(left, ramp_time) : 0.0;
  }
  return factor;
}

std::optional<double> Amplitude::final() const {
  if (duration > 0.0) return 0.0;
  if (frequency > 0.0) return std::nullopt;
  return 1.0;
}

double Amplitude::settled_from() const {
  if (duration > 0.0) return duration;
  return frequency > 0.0 ? std::numeric_limits<double>::infinity() : ramp_time;
}

Amplitude amplitude_of(const EffectSpec& spec) {
  const auto value = [&](const std::string& name) {
    return spec.parameters.contains(name) ? spec.number(name) : 0.0;
  };
  return {value("ramp_time"), value("frequency"), value("duration")};
}

}  // namespace hompm
