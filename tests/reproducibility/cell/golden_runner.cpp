// golden_runner OUTPUT GOLDEN_OR_SCENE...: runs the scene of each golden folder, or each scene file, into the
// folder of the same name below OUTPUT. hompm-run without its command line, so that a foreign architecture
// needs nothing but headers. A build of the whole library also leaves what hompm-run tells about a scene
// file: VTU files, errors against the reference solution, a checkpoint, a trace, or why it was refused.
// golden_runner --words prints what the keys of a scene may say, and the effects.
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>

#include <hompm/error.hpp>
#include <hompm/kit/output/run_folder.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/simulation/run.hpp>
#ifdef HOMPM_WHOLE
#include <hompm/kit/output/run_report.hpp>
#include <hompm/kit/recorder/checkpoint.hpp>
#include <hompm/kit/recorder/trace.hpp>
#endif

namespace {

namespace fs = std::filesystem;

void run_golden(const fs::path& golden, const fs::path& output) {
  const hompm::Scene scene = hompm::load_scene(golden / "scene.toml", {});
  hompm::RunFolder folder(output / golden.filename(), false);
  hompm::run(scene, hompm::time_stepping(scene),
             {.snapshot = [&](const hompm::Snapshot& snapshot) { folder.write(snapshot); },
              .history = [&](const hompm::HistoryRow& row) { folder.write(row); },
              .progress = {}});
  folder.write("scene.toml", hompm::scene_text(scene));
  folder.publish();
}

#ifdef HOMPM_WHOLE
void run_scene_file(const fs::path& path, const fs::path& output) {
  const hompm::Scene scene = hompm::load_scene(path, {});
  const hompm::TimeStepping stepping = hompm::time_stepping(scene);
  hompm::RunFolder folder(output / path.stem(), true);
  hompm::Trace trace(folder.path() / "trace");
  hompm::Checkpoint kept = hompm::first_checkpoint(scene);
  std::string checkpoint;
  hompm::RunObserver observer;
  observer.snapshot = [&](const hompm::Snapshot& snapshot) {
    folder.write(snapshot);
    kept.snapshots.push_back(snapshot);
  };
  observer.history = [&](const hompm::HistoryRow& row) {
    folder.write(row);
    kept.history.push_back(row);
  };
  observer.start = [&](hompm::Simulation& simulation) { trace.attach(scene, simulation); };
  observer.checkpoint_every = 16;
  observer.checkpoint = [&](const hompm::RunPoint& point) {
    kept.point = point;
    checkpoint = hompm::checkpoint_bytes(kept);
  };
  const hompm::RunResult result = hompm::run(scene, stepping, observer);
  trace.close();
  std::string reason;
  const auto errors = hompm::judge(scene, result, reason);
  const hompm::RunReport report{scene, stepping, result, errors, reason};
  const std::string json = hompm::run_json(report);
  folder.write("scene.toml", hompm::scene_text(scene));
  folder.write("run.json", json.substr(0, json.find("\"build\"")));  // which differs, as it must
  folder.write("summary.txt", hompm::run_summary(report));
  folder.write("last-checkpoint", checkpoint);
  folder.publish();
}

void run_or_refuse(const fs::path& path, const fs::path& output) {
  try {
    run_scene_file(path, output);
  } catch (const hompm::Error& error) {
    fs::create_directories(output / path.stem());
    std::ofstream(output / path.stem() / "refused.txt") << error.what() << '\n';
  }
}

void print_words() {
  for (const auto& key : hompm::scene_keys())
    for (const auto& word : key.words) std::cout << key.path << ' ' << word << '\n';
  for (const auto& effect : hompm::effect_catalogue()) std::cout << "effect " << effect.name << '\n';
}
#endif

}  // namespace

int main(int argc, char** argv) {
  try {
#ifdef HOMPM_WHOLE
    if (argc == 2 && std::string(argv[1]) == "--words") print_words();
#endif
    for (int i = 2; i < argc; ++i) {
#ifdef HOMPM_WHOLE
      if (!fs::is_directory(argv[i])) {
        run_or_refuse(argv[i], argv[1]);
        continue;
      }
#endif
      run_golden(argv[i], argv[1]);
    }
  } catch (const std::exception& error) {
    std::cerr << "golden_runner: " << error.what() << '\n';
    return 1;
  }
}
