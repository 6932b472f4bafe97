// States of a run on their way to the process that steps from them under callgrind.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <span>

#include <hompm/error.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/simulation/simulation.hpp>
#include <hompm/study/measure.hpp>

namespace hompm::study {
namespace {

/// A field of the particles in a snapshot and in the state.
struct Field {
  std::vector<double> Snapshot::*reported;
  std::vector<double> Particles::*kept;
};
constexpr std::array<Field, 6> fields{{{&Snapshot::displacement, &Particles::displacement},
                                       {&Snapshot::position, &Particles::position},
                                       {&Snapshot::velocity, &Particles::velocity},
                                       {&Snapshot::volume, &Particles::volume},
                                       {&Snapshot::stretch, &Particles::stretch},
                                       {&Snapshot::stress, &Particles::stress}}};

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }  // NOLINT: the owner
};
using File = std::unique_ptr<std::FILE, Closer>;

File open(const std::filesystem::path& path, const char* mode) {
  File file(std::fopen(path.c_str(), mode));
  if (!file) throw FileError(*mode == 'r' ? "read" : "write", path, errno);
  return file;
}

/// A marker at a free end goes where the particles beside it point; one at a fixed end stays.
void place_marker(Particles& p, std::size_t marker, std::size_t beside, std::size_t next, End end) {
  if (end == End::fixed) return;
  const double way = (p.reference_position[marker] - p.reference_position[beside]) /
                     (p.reference_position[next] - p.reference_position[beside]);
  p.displacement[marker] = p.displacement[beside] + way * (p.displacement[next] - p.displacement[beside]);
  p.position[marker] = p.reference_position[marker] + p.displacement[marker];
  p.velocity[marker] = p.velocity[beside];
  p.stretch[marker] = p.stretch[beside];
}

void restore(const Scene& scene, std::FILE* file, const std::filesystem::path& path, State& state) {
  Particles& p = state.particles;
  const std::size_t count = p.size() - 2 * p.markers;
  for (const Field& field : fields) {
    const auto values = std::span(p.*field.kept).subspan(p.markers, count);
    if (std::fread(values.data(), sizeof(double), count, file) != count)
      throw FileError("read", path, errno != 0 ? errno : EIO);
  }
  if (p.markers > 0 && count > 1) {
    const std::size_t last = p.size() - 1;
    place_marker(p, 0, 1, 2, scene.ends.left);
    place_marker(p, last, last - 1, last - 2, scene.ends.right);
  }
  state.step = 1;  // not the first one, which finds the geometry ready
}

}  // namespace

void write_moments(const std::filesystem::path& folder, const Measured& measured) {
  const auto path = folder / "moments";
  const File file = open(path, "w");
  const std::array<double, 2> head{measured.stepping.time_step, static_cast<double>(measured.moments.size())};
  const auto write = [&](std::span<const double> values) {
    if (std::fwrite(values.data(), sizeof(double), values.size(), file.get()) != values.size())
      throw FileError("write", path, errno);
  };
  write(head);
  for (const Snapshot& moment : measured.moments)
    for (const Field& field : fields) write(moment.*field.reported);
  if (std::fflush(file.get()) != 0) throw FileError("write", path, errno);
  write_whole(folder / "scene.toml", measured.record.scene);
}

std::int64_t step_from_moments(const std::filesystem::path& folder) {
  const auto path = folder / "moments";
  const Scene scene = load_scene(folder / "scene.toml", {});
  const File file = open(path, "r");
  std::array<double, 2> head{};
  errno = 0;
  if (std::fread(head.data(), sizeof(double), head.size(), file.get()) != head.size())
    throw FileError("read", path, errno != 0 ? errno : EIO);
  const auto moments = static_cast<std::int64_t>(head[1]);
  Simulation simulation(scene, head[0]);
  for (std::int64_t moment = 0; moment < moments; ++moment) {
    restore(scene, file.get(), path, simulation.state());
    simulation.step();
  }
  return moments;
}

}  // namespace hompm::study
