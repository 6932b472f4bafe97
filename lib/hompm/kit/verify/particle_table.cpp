#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <hompm/error.hpp>
#include <hompm/kit/verify/particle_table.hpp>
#include <hompm/number.hpp>
#include <hompm/simulation/records.hpp>

namespace hompm::detail {
namespace {

// What a layout asks for before the fields that are compared.
enum Key : std::size_t { X, particle, body, keys };

TableLayout with_fields(TableLayout layout) {
  layout.lenient = true;
  layout.fields = {"X", "particle", "body"};
  layout.fields.insert(layout.fields.end(), particle_fields().begin(), particle_fields().end());
  return layout;
}

constexpr std::size_t x_field = keys;  // the first two of particle_fields()
constexpr std::size_t displacement_field = keys + 1;

}  // namespace

const std::vector<std::string>& particle_fields() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names;
    for (const auto& column : std::span(all_columns).last<7>()) names.emplace_back(column.name);
    return names;
  }();
  return all;
}

std::size_t ParticleFields::index_of(const std::string& name) const {
  return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
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

ParticleTable::ParticleTable(const std::filesystem::path& path, TableLayout layout, MessageLog& faults,
                             MessageLog& notes)
    : table_(path, with_fields(std::move(layout)), faults, notes) {
  for (std::size_t f = 0; f < particle_fields().size(); ++f) {
    if (!has(keys + f)) continue;
    fields_.push_back(particle_fields()[f]);
    columns_.push_back(keys + f);
  }
  require_columns();
  collect_times();
}

void ParticleTable::require_columns() {
  if (fields_.empty()) {
    std::string known;
    for (const auto& field : particle_fields()) known += (known.empty() ? "" : ", ") + field;
    table_.refuse(1, "there is no column to compare; known are " + known);
  }
  if (has(X)) return;
  if (has(x_field) && has(displacement_field)) return note("X is x - displacement");
  if (!has(x_field) || !has(particle))
    table_.refuse(1,
                  "the column `X` is missing, by which particles are matched; it may follow from x and "
                  "displacement, or from x and the particle's number");
  note("X is each particle's x at the first time");
}

void ParticleTable::collect_times() {
  const bool keeps_x = !has(X) && !has(displacement_field);
  Row row;
  while (table_.next(row)) {
    if (times_.empty() || row.key.time != times_.back()) times_.push_back(row.key.time);
    if (keeps_x && row.key.time == times_.front())
      first_x_[table_.value(row, particle)] = table_.value(row, x_field);
  }
  std::ranges::sort(times_);
  times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
  if (times_.empty()) table_.refuse(0, "there is no row with a readable time below the header");
}

double ParticleTable::X_of(const Row& row) {
  if (has(X)) return table_.value(row, X);
  if (has(displacement_field)) return table_.value(row, x_field) - table_.value(row, displacement_field);
  const double number = table_.value(row, particle);
  const auto found = first_x_.find(number);
  if (found != first_x_.end()) return found->second;
  if (!std::isnan(number))
    table_.fault(
        "particles without X", row.line,
        "particle " + to_text(number) + " is not there at the first time, which its X is taken from");
  return std::nan("");
}

std::vector<ParticleBlock> ParticleTable::read(std::span<const double> times) {
  std::vector<ParticleBlock> blocks(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    blocks[i].time = times[i];
    blocks[i].values.resize(fields_.size());
  }
  table_.rewind();
  Row row;
  ParticleBlock* block = nullptr;
  double before = std::nan("");
  while (table_.next(row)) {
    if (row.key.time != before) {
      before = row.key.time;
      const auto at = std::lower_bound(times.begin(), times.end(), before);
      block = at == times.end() || *at != before ? nullptr
                                                 : &blocks[static_cast<std::size_t>(at - times.begin())];
    }
    if (block == nullptr) continue;
    const double place = X_of(row);
    const double number = has(body) ? table_.value(row, body) : 0.0;
    if (std::isnan(place) || !(std::abs(number) < 1e9)) continue;
    block->X.push_back(place);
    if (has(body)) block->body.push_back(static_cast<std::int64_t>(number));
    for (std::size_t f = 0; f < fields_.size(); ++f)
      block->values[f].push_back(table_.value(row, columns_[f]));
  }
  for (auto& b : blocks) sort(b);
  return blocks;
}

void ParticleTable::sort(ParticleBlock& block) {
  const std::size_t n = block.X.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto body_of = [&](std::size_t i) { return block.body.empty() ? 0 : block.body[i]; };
  const auto key = [&](std::size_t i) { return std::pair(body_of(i), block.X[i]); };
  std::ranges::stable_sort(order, {}, key);

  // Groups of the same X: repeated particles, or a strip where every X is there more than once. What follows
  // from other columns is rounded.
  const double rounding =
      n == 0 || has(X)
          ? 0.0
          : 1e-12 * std::abs(*std::ranges::max_element(block.X, {}, [](double v) { return std::abs(v); }));
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0 && body_of(order[i]) == body_of(order[i - 1]) &&
        block.X[order[i]] - block.X[order[i - 1]] <= rounding)
      continue;
    starts.push_back(i);
  }
  const std::size_t groups = starts.size();
  starts.push_back(n);
  bool strip = groups > 0;
  for (std::size_t g = 0; g < groups; ++g) strip = strip && starts[g + 1] - starts[g] > 1;
  for (std::size_t g = 0; g < groups && !strip; ++g) {
    for (std::size_t i = starts[g] + 1; i < starts[g + 1]; ++i) {
      const bool several = has(particle) && !has(body);
      fault("particles there twice",
            "a particle with X = " + to_text(block.X[order[i]]) + " is there twice at time " +
                to_text(block.time) +
                (several ? "; bodies that overlap are told apart by a column `body`" : ""));
    }
  }
  const auto gather = [&](auto& values, bool averaged) {
    auto result = std::remove_reference_t<decltype(values)>();
    result.reserve(groups);
    double spread = 0.0;
    for (std::size_t g = 0; g < groups; ++g) {
      const auto first = values[order[starts[g]]];
      result.push_back(first);
      if (!strip || !averaged) continue;
      double sum = 0.0;  // of the distances: equal values stay what they are
      for (std::size_t i = starts[g]; i < starts[g + 1]; ++i) {
        sum += static_cast<double>(values[order[i]] - first);
        spread = std::max(spread, std::abs(static_cast<double>(values[order[i]] - first)));
      }
      result.back() += static_cast<std::remove_cvref_t<decltype(first)>>(
          sum / static_cast<double>(starts[g + 1] - starts[g]));
    }
    values = std::move(result);
    return spread;
  };
  std::string spreads;
  for (std::size_t f = 0; f < block.values.size(); ++f) {
    const double spread = gather(block.values[f], true);
    spreads += (f == 0 ? "" : ", ") + fields_[f] + " " + to_text(spread);
  }
  if (!block.body.empty()) gather(block.body, false);
  gather(block.X, true);
  if (strip)
    table_.note("strips", 0,
                std::to_string(n) + " rows at time " + to_text(block.time) +
                    " are averaged over those of the same X, " + std::to_string(groups) +
                    " of them; they lie apart by up to " + spreads);
}

ParticleFields read_golden(const std::filesystem::path& folder, MessageLog& faults, MessageLog& notes) {
  ParticleFields golden;
  bool any = false;
  for (const char* name : {"particles.csv", "stress.csv"}) {
    if (!std::filesystem::exists(folder / name)) continue;
    any = true;
    ParticleTable table(folder / name, {}, faults, notes);
    auto blocks = table.read(table.times());
    if (golden.blocks.empty()) {
      golden = {table.fields(), std::move(blocks)};
      continue;
    }
    const bool same = std::ranges::equal(golden.blocks, blocks, [](const auto& one, const auto& other) {
      return one.time == other.time && one.X == other.X && one.body == other.body;
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
  if (!any)
    throw FileError("cannot compare with " + folder.string() + ": it holds no particles.csv or stress.csv");
  return golden;
}

}  // namespace hompm::detail
