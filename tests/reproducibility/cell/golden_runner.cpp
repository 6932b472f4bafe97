// golden_runner OUTPUT GOLDEN...: runs the scene of each golden folder into the folder of the same name below
// OUTPUT. hompm-run without its command line and judge, so that a foreign architecture needs nothing but
// headers.
#include <exception>
#include <filesystem>
#include <iostream>

#include <hompm/output/run_folder.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/simulation/run.hpp>

namespace {

void run_scene_of(const std::filesystem::path& golden, const std::filesystem::path& output) {
  const hompm::Scene scene = hompm::load_scene(golden / "scene.toml", {});
  hompm::RunFolder folder(output / golden.filename(), false);
  hompm::run(scene, hompm::time_stepping(scene),
             {.snapshot = [&](const hompm::Snapshot& snapshot) { folder.write(snapshot); },
              .history = [&](const hompm::HistoryRow& row) { folder.write(row); },
              .progress = {}});
  folder.write("scene.toml", hompm::scene_text(scene));
  folder.publish();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    for (int i = 2; i < argc; ++i) run_scene_of(argv[i], argv[1]);
  } catch (const std::exception& error) {
    std::cerr << "golden_runner: " << error.what() << '\n';
    return 1;
  }
}
