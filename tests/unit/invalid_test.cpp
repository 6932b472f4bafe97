// Guards that no scene is known to reach: called by hand, they say what is wrong.
#include <algorithm>
#include <string>

#include <hompm/error.hpp>
#include <hompm/number.hpp>
#include <hompm/numerics/interpolating_spline.hpp>
#include <hompm/plan/invalid.hpp>
#include <hompm/scheme/motion.hpp>
#include <hompm/simulation/simulation.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"
#include "support/scenes.hpp"

using hompm::test::free_body;
using hompm::test::message_of;

TEST_CASE("a singular mass matrix is told with the place and what to change") {
  hompm::Simulation simulation(free_body(), 1e-3);  // degree 2, 16 cells of 4 particles in 0 … 1 m
  hompm::State state = simulation.state();
  state.step = 7;
  state.time = 0.5;
  const std::size_t function = 8;
  const auto message =
      message_of<hompm::InvalidRun>([&] { hompm::detail::throw_singular_mass(state, function); });
  const double from = state.grid.breakpoint(6), to = state.grid.breakpoint(9);
  const auto inside = std::count_if(state.particles.position.begin(), state.particles.position.end(),
                                    [&](double x) { return from <= x && x <= to; });
  CHECK(message == "invalid at step 7, t = 0.5 s: the consistent mass is singular at grid function 8, x = " +
                       hompm::to_text(from) + " ... " + hompm::to_text(to) + " m: " + std::to_string(inside) +
                       " particles there do not determine it; raise scheme.particles_per_cell, or lower "
                       "scheme.cells or scheme.degree");
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
