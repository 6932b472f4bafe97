#include <algorithm>
#include <cmath>
#include <variant>

#include <hompm/reference/closed_forms.hpp>

namespace hompm {

namespace {

/// u = displacement sin(kπX/L), v = velocity sin(kπX/L), `wave_number` k/L.
ReferenceFields standing_wave(const LinearBody& body, double displacement, double velocity,
                              double wave_number, std::span<const double> X) {
  const double stiffness = body.density * body.wave_speed * body.wave_speed;
  ReferenceFields fields;
  for (const double x : X) {
    const double sine = numerics::sin_pi(wave_number * x);
    fields.displacement.push_back(displacement * sine);
    fields.velocity.push_back(velocity * sine);
    fields.stress.push_back(stiffness * displacement * numerics::pi * wave_number *
                            numerics::cos_pi(wave_number * x));
  }
  return fields;
}

}  // namespace

ReferenceFields vibrating_bar(const LinearBody& body, double amplitude, int mode, double time,
                              std::span<const double> X) {
  const double wave_number = static_cast<double>(mode) / body.length;  // over π
  const double phase = wave_number * body.wave_speed * time;
  const double displacement =
      amplitude * numerics::sin_pi(phase) / (numerics::pi * wave_number * body.wave_speed);
  return standing_wave(body, displacement, amplitude * numerics::cos_pi(phase), wave_number, X);
}

ReferenceFields released_bar(const LinearBody& body, double amplitude, int mode, double time,
                             std::span<const double> X) {
  const double wave_number = static_cast<double>(mode) / body.length;  // over π
  const double phase = wave_number * body.wave_speed * time;
  const double velocity = -amplitude * numerics::pi * wave_number * body.wave_speed * numerics::sin_pi(phase);
  return standing_wave(body, amplitude * numerics::cos_pi(phase), velocity, wave_number, X);
}

ReferenceFields loaded_column(const LinearBody& body, double acceleration, double time,
                              std::span<const double> X) {
  const double c = body.wave_speed;
  const double period = 4.0 * body.length / c;
  double t = time - std::floor(time / period) * period;
  const bool backwards = t > 0.5 * period;
  if (backwards) t = period - t;

  ReferenceFields fields;
  for (const double x : X) {
    const double up = std::max(t - x / c, 0.0);
    const double down = std::max(t - (2.0 * body.length - x) / c, 0.0);
    const double velocity = acceleration * (t - up - down);
    fields.displacement.push_back(0.5 * acceleration * (t * t - up * up - down * down));
    fields.velocity.push_back(backwards ? -velocity : velocity);
    fields.stress.push_back(body.density * c * acceleration * (up - down));
  }
  return fields;
}

ReferenceFields manufactured_bar(const LinearBody& body, const Material& material, double amplitude,
                                 double time, std::span<const double> X) {
  const double phase = body.wave_speed * time / body.length;  // over π
  const double displacement = amplitude * numerics::sin_pi(phase);
  const double velocity = amplitude * numerics::pi * body.wave_speed / body.length * numerics::cos_pi(phase);
  ReferenceFields fields;
  for (const double x : X) {
    const double sine = numerics::sin_pi(x / body.length);
    const double strain = displacement * numerics::pi / body.length * numerics::cos_pi(x / body.length);
    fields.displacement.push_back(displacement * sine);
    fields.velocity.push_back(velocity * sine);
    fields.stress.push_back(std::visit([&](const auto& law) { return law.stress(1.0 + strain); }, material));
  }
  return fields;
}

}  // namespace hompm
