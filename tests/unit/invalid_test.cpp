// Guards that no scene is known to reach: called by hand, they say what is wrong.
#include <string>

#include <hompm/error.hpp>
#include <hompm/numerics/interpolating_spline.hpp>
#include <hompm/plan/invalid.hpp>
#include <hompm/scheme/motion.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/scenes.hpp"

using hompm::test::free_body;
using hompm::test::message_of;

TEST_CASE("a singular mass matrix is told by its grid function") {
  hompm::State state = hompm::initial_state(free_body());
  state.step = 7;
  state.time = 0.5;
  const auto message = message_of<hompm::InvalidRun>([&] { hompm::detail::throw_singular_mass(state, 3); });
  CHECK(message ==
        "invalid at step 7, t = 0.5 s: the consistent mass matrix is singular at grid function 3; use more "
        "particles per cell");
}

TEST_CASE("stretches need reference positions in ascending order") {
  using Splines = hompm::numerics::InterpolatingSplineSites<3>;
  hompm::Particles particles;
  particles.reference_position = {0.1, 0.2, 0.2, 0.4, 0.5, 0.6, 0.7};
  particles.mass.resize(7, 1.0);
  CHECK(message_of<hompm::Error>([&] { hompm::detail::StretchFromPositions<Splines>{particles}; }) ==
        "reference positions are not in ascending order");
}

TEST_CASE("a particle is told by its number, a marker by none") {
  hompm::State state = hompm::initial_state(free_body({{"scheme.name", "high-order"}}));
  const std::size_t last = state.particles.size() - 1;
  const auto message = [&](std::size_t index) {
    return message_of<hompm::InvalidRun>([&] { hompm::detail::throw_left_grid(state, index); });
  };
  CHECK_THAT(message(1), hompm::test::contains("particle 0"));
  CHECK_THAT(message(last - 1), hompm::test::contains("particle 63"));
  for (const std::size_t marker : {std::size_t{0}, last})
    CHECK(message(marker).find("particle") == std::string::npos);
}
