// An effect of one's own: drag, the body force b = −k |v| v, with a field of its own, the heat it makes; and
// a program that runs scenes with it.
//
//   drag SCENE                      velocity and energy residual at the end
//   drag SCENE FOLDER [CHECKPOINT]  the same, with results, a trace and a checkpoint in FOLDER; from a
//   checkpoint on
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>

#include <hompm/effects/registry.hpp>
#include <hompm/error.hpp>
#include <hompm/kit/output/run_folder.hpp>
#include <hompm/kit/recorder/checkpoint.hpp>
#include <hompm/kit/recorder/trace.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/plan/plan.hpp>
#include <hompm/simulation/run.hpp>

namespace {

using hompm::operator""_field;

void join(const hompm::EffectSpec& spec, const hompm::PlanBuilder& builder) {
  const double k = spec.number("coefficient");
  const hompm::Field heat = builder.field({.name = "drag_heat",
                                           .unit = "J/m^2",
                                           .meaning = "that the drag on a particle has made",
                                           .persists = true,
                                           .reported = true});
  builder.add(
      {.name = "drag",
       .phase = hompm::Phase::acceleration,
       .reads = {"particles.mass"_field},
       .changes = {"particles.velocity"_field, heat, "balance.dissipated"_field, "balance.impulse"_field},
       .run = [k, heat](hompm::State& state) {
         hompm::Particles& p = state.particles;
         auto& heat_of = state[heat];
         for (std::size_t i = 0; i < p.size(); ++i) {
           const double change = -state.kick * k * std::abs(p.velocity[i]) * p.velocity[i];
           const double made = -p.mass[i] * change * (p.velocity[i] + 0.5 * change);
           heat_of[i] += made;
           state.balance.dissipated += made;
           state.balance.impulse += p.mass[i] * change;
           p.velocity[i] += change;
         }
       }});
}

hompm::EffectType drag() {
  return {.name = "drag",
          .meaning = "body force against the velocity, b = -coefficient |v| v",
          .parameters = {{.name = "coefficient", .unit = "1/m", .meaning = "of the drag", .minimum = 0.0}},
          .join = join};
}

/// Into a folder, with a trace and the checkpoint of half-way; from a checkpoint where there is one.
hompm::RunResult run_into(const std::filesystem::path& path, const hompm::Scene& scene,
                          const std::optional<hompm::Checkpoint>& from) {
  const hompm::TimeStepping stepping = hompm::time_stepping(scene);
  hompm::Checkpoint checkpoint = from ? *from : hompm::first_checkpoint(scene);
  hompm::RunFolder folder(path, true);
  for (const auto& row : checkpoint.history) folder.write(row);
  for (const auto& snapshot : checkpoint.snapshots) folder.write(snapshot);
  hompm::Trace trace(path / "trace");
  hompm::RunObserver observer;
  observer.start = [&](hompm::Simulation& simulation) { trace.attach(scene, simulation); };
  observer.history = [&](const hompm::HistoryRow& row) {
    folder.write(row);
    checkpoint.history.push_back(row);
  };
  observer.snapshot = [&](const hompm::Snapshot& snapshot) {
    folder.write(snapshot);
    checkpoint.snapshots.push_back(snapshot);
  };
  observer.checkpoint_every = stepping.steps / 2;
  observer.checkpoint = [&](const hompm::RunPoint& point) {
    checkpoint.point = point;
    std::ofstream(path / "half", std::ios::binary) << hompm::checkpoint_bytes(checkpoint);
  };
  const auto result = hompm::run(scene, stepping, observer, from ? &from->point : nullptr);
  trace.close();
  folder.publish();
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 4) return 2;
  try {
    hompm::EffectCatalogue effects = hompm::effect_catalogue();
    effects.push_back(drag());
    const hompm::Scene scene = hompm::load_scene(argv[1], {}, effects);
    std::optional<hompm::Checkpoint> from;
    if (argc == 4) from = hompm::read_checkpoint(argv[3], effects);
    const hompm::RunResult result =
        argc > 2 ? run_into(argv[2], scene, from) : hompm::run(scene, hompm::time_stepping(scene));
    std::cout << result.end.momentum / result.end.mass << ' ' << result.largest_residual << '\n';
  } catch (const hompm::Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
