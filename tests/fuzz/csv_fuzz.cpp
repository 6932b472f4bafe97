// Any bytes are a table or are refused; a table without faults is identical to itself.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/kit/verify/particle_table.hpp>
#include <hompm/kit/verify/table.hpp>
#include <hompm/kit/verify/table_comparison.hpp>

#include "demand.hpp"
#include "memory_file.hpp"

namespace {

using namespace hompm;
using namespace hompm::detail;

const std::vector<std::string> fields{"displacement", "velocity", "stress"};
const std::string golden = R"(time,particle,displacement,velocity,stress
0,0,0,0.006135884649154475,0
0,1,0,0.01840672990580482,0
0.5,0,0.0014,-0.003,12.5
0.5,1,0.004,1e-17,-3e100
)";

void compare(const MemoryFile& a, const MemoryFile& b, bool with_particles) {
  MessageLog faults;
  MessageLog notes;
  const TableLayout layout{.fields = fields, .with_particles = with_particles};
  Table table_a(a.path(), layout, faults, notes);
  Table table_b(b.path(), layout, faults, notes);
  FieldJudge judge("table.csv", fields, std::vector<Tolerance>(fields.size(), {.relative = 1e-3}));
  if (table_a.has_keys() && table_b.has_keys()) compare_tables(table_a, table_b, fields.size(), judge);
  demand(&a != &b || !judge.first().has_value(), "a table is identical to itself");
  for (const std::string& message : faults.messages()) demand(message.size() < 2000, message);
}

void read_foreign(const MemoryFile& file, std::optional<double> only_time) {
  MessageLog faults;
  MessageLog notes;
  ParticleTable table(file.path(), {.only_time = only_time}, faults, notes);
  const std::vector<ParticleBlock> blocks = table.read(table.times());
  demand(blocks.size() == table.times().size(), "each time has its block");
  for (const ParticleBlock& block : blocks) {
    for (std::size_t i = 1; i < block.X.size(); ++i) {
      const bool next = !block.body.empty() && block.body[i - 1] < block.body[i];
      demand(next || block.X[i - 1] < block.X[i], "X ascends in a body");
    }
    demand(block.values.size() == table.fields().size(), "each field has its values");
    for (const auto& values : block.values)
      demand(values.size() == block.X.size(), "each particle has its value");
  }
}

void attempt(const std::function<void()>& action) {
  try {
    action();
  } catch (const FileError&) {  // a line too long, or nothing in it to compare
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const MemoryFile sound(golden.data(), golden.size());
  const MemoryFile file(data, size);
  for (const bool with_particles : {true, false}) {
    attempt([&] { compare(file, file, with_particles); });
    attempt([&] { compare(file, sound, with_particles); });
    attempt([&] { compare(sound, file, with_particles); });
  }
  attempt([&] { read_foreign(file, std::nullopt); });
  attempt([&] { read_foreign(file, 0.5); });
  return 0;
}
