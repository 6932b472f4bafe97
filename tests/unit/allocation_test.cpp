// The step loop takes no memory: operator new is counted. Left out under sanitizers, which bring their own.
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <new>

#include <hompm/scheme/scheme.hpp>
#include <hompm/simulation/run.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace {
std::atomic<long> allocations{0};
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

TEST_CASE("no scheme and no effect allocates in a step") {
  const auto& scheme = GENERATE(from_range(hompm::scheme_table()));
  const auto scene = hompm::parse_scene(R"(
end_time = 1
body.length = 1
material = { law = "hencky", density = 1000, youngs_modulus = 1e5 }
ends.right = "free"
effect = [ { type = "gravity", acceleration = -9.81 }, { type = "traction", value = 10 },
           { type = "mass-damping", rate = 1 }, { type = "local-damping", coefficient = 0.1 },
           { type = "viscosity", viscosity = 1 }, { type = "bulk-viscosity" } ]
scheme = { name = ")" + scheme.name + R"(", cells = 16, particles_per_cell = 4, time_step = 1e-4 })",
                                        "allocation test", {});
  hompm::Simulation simulation(scene, 1e-4);
  const long before = allocations;
  for (int step = 0; step < 500; ++step) simulation.step();
  CHECK(allocations == before);
  CHECK(before > 0);
}

TEST_CASE("no effect of an example scene allocates in a step, in contact or not") {
  for (const auto& entry : std::filesystem::directory_iterator(HOMPM_SOURCE_DIR "/docs/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    INFO(entry.path());
    const auto scene = hompm::load_scene(entry.path().string(), {{"scheme.cells", "16", "--cells"}});
    hompm::Simulation simulation(scene, hompm::time_stepping(scene).time_step);
    const long before = allocations;
    for (int step = 0; step < 200; ++step) simulation.step();
    CHECK(allocations == before);
  }
}
