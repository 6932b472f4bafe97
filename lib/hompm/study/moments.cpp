// States of a run on their way to the process that steps from them under callgrind.
#include <hompm/error.hpp>
#include <hompm/recorder/state_bytes.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/simulation/simulation.hpp>
#include <hompm/study/measure.hpp>

namespace hompm::study {

void write_moments(const std::filesystem::path& folder, const Measured& measured) {
  detail::ByteWriter out;
  out.number(measured.stepping.time_step);
  out.word(measured.moments.size());
  for (const State& moment : measured.moments) detail::write_state(out, moment);
  write_whole(folder / "moments", out.bytes);
  write_whole(folder / "scene.toml", measured.record.scene);
}

std::int64_t step_from_moments(const std::filesystem::path& folder) {
  const Scene scene = load_scene(folder / "scene.toml", {});
  const auto path = folder / "moments";
  const std::string bytes = detail::read_bytes(path);
  detail::ByteReader in(bytes);
  const auto readable = [&](const auto& read) {
    try {
      return read();
    } catch (const Error& error) {
      throw FileError("cannot read " + path.string() + ": " + error.what());
    }
  };
  Simulation simulation(scene, readable([&] { return in.number(); }));
  const std::size_t moments = readable([&] { return in.count(8); });
  for (std::size_t moment = 0; moment < moments; ++moment) {
    readable([&] { detail::read_state(in, simulation.state()); });
    simulation.step();
  }
  return static_cast<std::int64_t>(moments);
}

}  // namespace hompm::study
