// Any bytes are a trace or are refused; a trace is identical to itself, and is compared with one of which a
// byte is another.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <string>

#include <hompm/error.hpp>
#include <hompm/kit/recorder/bytes.hpp>
#include <hompm/kit/recorder/trace.hpp>
#include <hompm/kit/recorder/trace_file.hpp>
#include <hompm/simulation/run.hpp>

#include "demand.hpp"
#include "memory_file.hpp"
#include "seeds.hpp"

namespace {

using namespace hompm;

/// With the end that makes it whole.
std::string ended(std::string bytes) {
  detail::ByteWriter end;
  end.word<2>(detail::trace_end);
  end.word(detail::hash_of_bytes(bytes));
  return bytes.append(end.bytes);
}

void compare(const std::string& text_a, const std::string& text_b) {
  const MemoryFile a(text_a);
  const MemoryFile b(text_b);
  try {
    const TraceComparison found = compare_traces(a.path(), b.path());
    demand(text_a != text_b || found.identical, "a trace is identical to itself");
    demand(found.identical == (!found.first && found.messages.empty()), "a difference is told");
  } catch (const FileError&) {
  }
}

/// The first bytes of the trace of a run; without its end.
std::string seed_of(const Scene& scene) {
  const std::string path =
      std::filesystem::temp_directory_path() / ("hompm-seed-" + std::to_string(::getpid()));
  Trace trace(path, {.values_from = 2, .values_bytes = 1 << 14});
  RunObserver observer;
  observer.start = [&](Simulation& simulation) { trace.attach(scene, simulation); };
  TimeStepping stepping = time_stepping(scene);
  stepping.steps = 3;
  run(scene, stepping, observer, nullptr);
  trace.close();
  std::ifstream in(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  std::filesystem::remove(path);
  return bytes.substr(0, bytes.size() - 10);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  write_seeds(seed_of);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  compare(text, text);
  compare(ended(text), ended(text));
  if (size < 2) return 0;
  std::string other = text;  // the last byte says where
  other[(size - 1) * data[size - 1] / 256] ^= 1;
  compare(text, other);
  compare(ended(text), ended(other));
  return 0;
}
