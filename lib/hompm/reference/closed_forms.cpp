#include <algorithm>
#include <cmath>
#include <variant>

#include <hompm/reference/closed_forms.hpp>

namespace hompm {

namespace {

struct Wave {
  double value, slope;
};

/// F(s), `rising`, or G(s): back through the reflections to the start.
Wave traced(const WaveProblem& problem, double s, bool rising) {
  const auto& [length, density, c] = problem.body;
  const double bend = 0.5 * problem.acceleration / (c * c);
  const auto& v = problem.velocity;
  const auto& u = problem.displacement;
  Wave sum{0.0, 0.0};
  Wave sign{1.0, 1.0};
  for (; rising ? s < 0.0 : s > length; rising = !rising) {
    const double way = rising ? -s : s - length;  // since the reflection
    const double side = rising ? -1.0 : 1.0;
    if ((rising ? problem.ends.left : problem.ends.right) == End::fixed) {
      sum.value -= sign.value * bend * way * way;
      sum.slope -= sign.slope * side * 2.0 * bend * way;
      sign.value = -sign.value;
    } else {
      const double strain = (rising ? problem.left : problem.right) / (density * c * c);
      const double start = !rising && v ? v->integral_to(1.0, length) / c : 0.0;
      sum.value += sign.value * (side * strain * way + start);
      sum.slope += sign.slope * strain;
      sign.slope = -sign.slope;
    }
    s = rising ? way : length - way;
  }
  const double place = s / length;
  const double side = rising ? -0.5 : 0.5;
  Wave start{0.0, 0.0};
  if (u) start = {0.5 * u->at(place, length), 0.5 * u->slope_at(place, length)};
  if (v) start.value += side * v->integral_to(place, length) / c;
  if (v) start.slope += side * v->at(place, length) / c;
  return {sum.value + sign.value * start.value, sum.slope + sign.slope * start.slope};
}

}  // namespace

ReferenceFields travelling_waves(const WaveProblem& problem, double time, std::span<const double> X) {
  const double c = problem.body.wave_speed;
  const double b = problem.acceleration;
  if (problem.ends.left == End::fixed || problem.ends.right == End::fixed) {
    const double period = 4.0 * problem.body.length / c;
    time -= std::floor(time / period) * period;
  }
  ReferenceFields fields;
  for (const double x : X) {
    const Wave rising = traced(problem, x - c * time, true);
    const Wave falling = traced(problem, x + c * time, false);
    const double strain = rising.slope + falling.slope;
    fields.displacement.push_back(0.5 * b * time * time + rising.value + falling.value);
    fields.velocity.push_back(b * time + c * (falling.slope - rising.slope));
    fields.stress.push_back(problem.body.density * c * c * strain);
    fields.stretch.push_back(1.0 + strain);
  }
  return fields;
}

double front_from_left(const LinearBody& body, double time) {
  const double trips = 0.5 * body.wave_speed * time / body.length;
  const double way = 2.0 * body.length * (trips - std::floor(trips));
  return std::min(way, 2.0 * body.length - way);
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
    fields.stretch.push_back(1.0 + strain);
  }
  return fields;
}

std::vector<double> manufactured_force(const LinearBody& body, const Material& material, double amplitude,
                                       double time, std::span<const double> X) {
  const double wave_number = numerics::pi / body.length;
  const double now = amplitude * numerics::sin_pi(body.wave_speed * time / body.length);
  const double omega = wave_number * body.wave_speed;
  std::vector<double> forces;
  for (const double x : X) {
    const double stretch = 1.0 + now * wave_number * numerics::cos_pi(x / body.length);
    const double tangent = std::visit([&](const auto& law) { return law.tangent(stretch); }, material);
    const double slope = tangent / body.density * wave_number * wave_number;
    forces.push_back(now * numerics::sin_pi(x / body.length) * (slope - omega * omega));
  }
  return forces;
}

}  // namespace hompm
