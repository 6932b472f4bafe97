#include <algorithm>
#include <cmath>

#include <hompm/error.hpp>
#include <hompm/number.hpp>
#include <hompm/verify/foreign_comparison.hpp>
#include <hompm/verify/foreign_golden.hpp>

namespace hompm::detail {

std::size_t ParticleFields::index_of(const std::string& name) const {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

double ParticleFields::largest(const std::string& name) const {
  double scale = 0.0;
  for (std::size_t t = 0; t < blocks.size(); ++t)
    for (const double value : values(name, t)) scale = std::max(scale, std::abs(value));  // passes over NaN
  return scale;
}

void ParticleFields::derive_displacement() {
  if (!has("x")) return;
  if (!has("displacement")) names.emplace_back("displacement");
  for (auto& block : blocks) {
    block.values.resize(names.size());
    auto& u = block.values[index_of("displacement")];
    u = block.values[index_of("x")];
    for (std::size_t p = 0; p < u.size(); ++p) u[p] -= block.X[p];
  }
}

ParticleFields read_golden(const std::filesystem::path& folder, MessageLog& faults, MessageLog& notes) {
  if (std::error_code error; !std::filesystem::is_directory(folder, error)) {
    throw FileError("cannot compare with " + folder.string() + ": it is not a folder");
  }
  ParticleFields golden;
  bool any = false;
  for (const char* name : {"particles.csv", "stress.csv"}) {
    if (!std::filesystem::exists(folder / name)) continue;
    any = true;
    ForeignTable table(folder / name, foreign_fields(), std::nullopt, faults, notes);
    if (!table.is_usable()) continue;
    auto blocks = table.read(table.times());
    if (golden.blocks.empty()) {
      golden = {table.fields(), std::move(blocks)};
      continue;
    }
    const bool same = std::ranges::equal(golden.blocks, blocks, [](const auto& one, const auto& other) {
      return one.time == other.time && one.X == other.X;
    });
    if (!same) {
      table.fault("other particles", "times or particles are not those of particles.csv");
      continue;
    }
    for (std::size_t f = 0; f < table.fields().size(); ++f) {
      if (golden.has(table.fields()[f])) continue;
      golden.names.push_back(table.fields()[f]);
      for (std::size_t t = 0; t < blocks.size(); ++t)
        golden.blocks[t].values.push_back(std::move(blocks[t].values[f]));
    }
  }
  if (!any) {
    throw FileError("cannot compare with " + folder.string() + ": it holds no particles.csv or stress.csv");
  }
  return golden;
}

std::vector<std::size_t> wanted_blocks(const ParticleFields& golden, const std::vector<double>& asked) {
  std::vector<std::size_t> wanted;
  std::string known;
  for (std::size_t t = 0; t < golden.blocks.size(); ++t) {
    known += (t == 0 ? "" : ", ") + to_text(golden.blocks[t].time);
    if (asked.empty()) wanted.push_back(t);
  }
  for (const double time : asked) {
    const auto found = std::ranges::find_if(golden.blocks, [&](const ParticleBlock& block) {
      return std::abs(block.time - time) <= 1e-9 * golden.blocks.back().time;
    });
    if (found == golden.blocks.end()) {
      throw OptionError("--time " + to_text(time) + ": B has only the times " + known);
    }
    wanted.push_back(static_cast<std::size_t>(found - golden.blocks.begin()));
  }
  std::ranges::sort(wanted);
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  return wanted;
}

}  // namespace hompm::detail
