// Any bytes are a checkpoint or are refused; what is read is written as it was, and goes on or becomes
// invalid. The bytes are the content behind the identity of the build: head, length and checksum are put
// before them, for no mutation would keep these.
#include <cstddef>
#include <cstdint>
#include <string>

#include <hompm/error.hpp>
#include <hompm/kit/recorder/bytes.hpp>
#include <hompm/kit/recorder/checkpoint.hpp>
#include <hompm/simulation/run.hpp>

#include "demand.hpp"
#include "seeds.hpp"

namespace {

using namespace hompm;

constexpr std::size_t head_size = 40;

/// Of a checkpoint of this build, what stands before the text of the scene.
std::string identity() {
  const std::string bytes = checkpoint_bytes(first_checkpoint(seed_scenes().front()));
  detail::ByteReader in(std::string_view(bytes).substr(head_size));
  detail::ByteWriter out;
  out.text(in.text());
  return out.bytes;
}

std::string with_head(const std::string& content) {
  static const std::string magic = "hompm checkpoint";
  detail::ByteWriter head;
  head.bytes = magic;
  head.word(2);
  head.word(content.size());
  head.word(detail::hash_of_bytes(content));
  return head.bytes + content;
}

/// Two steps from it, unless the scene is large.
void go_on(const Checkpoint& checkpoint) {
  std::int64_t particles = 0;
  for (const Scene* body : bodies_of(checkpoint.scene))
    particles += std::int64_t{body->scheme.cells} * body->scheme.particles_per_cell;
  if (particles > 200) return;
  try {
    TimeStepping stepping = time_stepping(checkpoint.scene);
    const std::int64_t step = checkpoint.point.states.front().step;
    stepping.steps = step < stepping.steps - 2 ? step + 2 : stepping.steps;
    run(checkpoint.scene, stepping, {}, &checkpoint.point);
  } catch (const InvalidRun&) {
  } catch (const SceneError&) {  // no such step
  }
}

std::string seed_of(const Scene& scene) {
  Checkpoint checkpoint = first_checkpoint(scene);
  RunObserver observer;
  observer.checkpoint_every = checkpoint.every = 5;
  observer.history = [&](const HistoryRow& row) { checkpoint.history.push_back(row); };
  observer.snapshot = [&](const Snapshot& snapshot) { checkpoint.snapshots.push_back(snapshot); };
  std::string bytes;
  observer.checkpoint = [&](const RunPoint& point) {
    checkpoint.point = point;
    bytes = checkpoint_bytes(checkpoint);
  };
  run(scene, time_stepping(scene), observer, nullptr);
  return bytes.substr(head_size + identity().size());
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  write_seeds(seed_of);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string build = identity();
  const std::string bytes = with_head(build + std::string(reinterpret_cast<const char*>(data), size));
  try {
    const Checkpoint checkpoint = parse_checkpoint(bytes, "fuzzed");
    const std::string written = checkpoint_bytes(checkpoint);
    demand(checkpoint_bytes(parse_checkpoint(written, "written")) == written,
           "a written checkpoint is the same checkpoint");
    go_on(checkpoint);
  } catch (const CheckpointError&) {
  }
  return 0;
}
