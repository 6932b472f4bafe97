// What of a load acts at a time.
#include <optional>

#include <hompm/scene/amplitude.hpp>

#include "support/catch.hpp"

using hompm::Amplitude;

TEST_CASE("a load without a shape acts in full from the start") {
  const Amplitude constant;
  CHECK(constant.constant());
  CHECK_FALSE(constant.smooth());
  CHECK(constant(0.0) == 1.0);
  CHECK(constant(1e9) == 1.0);
  CHECK(constant.final() == 1.0);
}

TEST_CASE("a ramp ends in full, and a duration in nothing, both as smoothly") {
  const Amplitude pulse{.ramp_time = 2.0, .duration = 8.0};
  CHECK(pulse(0.0) == 0.0);
  CHECK(pulse(1.0) == 0.5);
  CHECK(pulse(2.0) == 1.0);
  CHECK(pulse(6.0) == 1.0);
  CHECK(pulse(7.0) == 0.5);
  CHECK(pulse(8.0) == 0.0);
  CHECK(pulse(9.0) == 0.0);
  CHECK(pulse.smooth());
  CHECK_FALSE(pulse.constant());
  CHECK(pulse.final() == 0.0);
  CHECK(Amplitude{.duration = 8.0}(7.9) == 1.0);
  CHECK(Amplitude{.duration = 8.0}(8.0) == 0.0);
  CHECK(Amplitude{.ramp_time = 2.0}.final() == 1.0);
}

TEST_CASE("a frequency is that of a sine, whose end is not known") {
  const Amplitude sine{.frequency = 0.25};
  CHECK(sine(0.0) == 0.0);
  CHECK(sine(1.0) == 1.0);
  CHECK(sine(2.0) == 0.0);
  CHECK(sine(3.0) == -1.0);
  CHECK(sine.final() == std::nullopt);
  CHECK(Amplitude{.ramp_time = 2.0, .frequency = 0.25}(1.0) == 0.5);
}

TEST_CASE("an effect that says nothing about time has a constant load") {
  CHECK(hompm::amplitude_of({"gravity", {{"acceleration", 1.0}}, {}}).constant());
  const auto amplitude =
      hompm::amplitude_of({"gravity", {{"ramp_time", 1.0}, {"frequency", 2.0}, {"duration", 3.0}}, {}});
  CHECK(amplitude.ramp_time == 1.0);
  CHECK(amplitude.frequency == 2.0);
  CHECK(amplitude.duration == 3.0);
}
