#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <hompm/number.hpp>
#include <hompm/scene_file/reader.hpp>
#include <hompm/verify/csv_text.hpp>
#include <hompm/verify/excerpt.hpp>
#include <hompm/verify/foreign_table.hpp>

namespace hompm::detail {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// A column name without the quotes some writers put around it.
std::string_view unquoted(std::string_view name) {
  name = trimmed(name);
  const bool quoted = name.size() > 1 && name.front() == '"' && name.back() == '"';
  return quoted ? name.substr(1, name.size() - 2) : name;
}

/// A header without byte order mark (spreadsheets) and leading # (numpy.savetxt).
std::string_view bare(std::string_view header) {
  if (header.starts_with("\xef\xbb\xbf")) header.remove_prefix(3);
  header = trimmed(header);
  if (header.starts_with('#')) header.remove_prefix(1);
  return trimmed(header);
}

}  // namespace

ForeignTable::ForeignTable(std::filesystem::path path, std::span<const std::string> fields,
                           std::optional<double> only_time, MessageLog& faults, MessageLog& notes)
    : path_(std::move(path)), name_(path_.string()), only_time_(only_time), faults_(faults), notes_(notes) {
  LineReader reader(path_);
  read_header(reader, fields);
  if (usable_) collect_times(reader);
}

void ForeignTable::read_header(LineReader& reader, std::span<const std::string> wanted) {
  if (!reader.next()) return fault("empty files", "the file is empty");
  const std::string header(bare(reader.line()));
  if (const std::string other = other_separator(header); !other.empty()) {
    return faults_.add(name_, "separators", 1, other);
  }
  split_at_commas(header, ends_);
  for (std::size_t i = 0; i < ends_.size(); ++i) header_.emplace_back(unquoted(field_of(header, ends_, i)));
  find_columns(wanted);
}

void ForeignTable::find_columns(std::span<const std::string> wanted) {
  std::vector<std::string> known{"time", "X", "particle"};
  known.insert(known.end(), wanted.begin(), wanted.end());
  const auto line = [](const std::string& text) { return std::pair<std::int64_t, std::string>(1, text); };
  const auto complain = [&](const std::string& kind, const std::pair<std::int64_t, std::string>& what) {
    faults_.add(name_, kind, what.first, what.second);
  };
  std::string others;
  for (auto name = header_.begin(); name != header_.end(); ++name) {
    if (std::find(known.begin(), known.end(), *name) == known.end()) {
      const std::string meant = nearest(*name, known);
      others += (others.empty() ? "" : ", ") + excerpt(*name) +
                (meant.empty() || std::count(header_.begin(), header_.end(), meant) > 0
                     ? ""
                     : " (did you mean " + meant + "?)");
    } else if (std::find(header_.begin(), name, *name) != name) {
      complain("repeated columns", line("the column `" + *name + "` is there twice"));
      return;
    }
  }
  if (!others.empty()) note("columns not looked at: " + others);

  const auto find = [&](const std::string& name) -> std::optional<std::size_t> {
    const auto at = std::find(header_.begin(), header_.end(), name);
    if (at == header_.end()) return std::nullopt;
    return static_cast<std::size_t>(at - header_.begin());
  };
  for (const auto& name : wanted) {
    if (const auto column = find(name)) {
      fields_.push_back(name);
      columns_.push_back(*column);
    }
  }
  time_column_ = find("time");
  const auto X = find("X");
  if (!X) complain("missing columns", line("the column `X` is missing, by which particles are matched"));
  if (!time_column_ && !only_time_) {
    complain("missing columns",
             line("the column `time` is missing; --time T says at which time all rows are"));
  }
  if (fields_.empty()) {
    std::string names;
    for (const auto& name : wanted) names += (names.empty() ? "" : ", ") + name;
    complain("missing columns", line("there is no column to compare; known are " + names));
  }
  X_column_ = X.value_or(0);
  usable_ = X && (time_column_ || only_time_) && !fields_.empty();
}

std::string_view ForeignTable::field(std::size_t column) const {
  std::string_view text = trimmed(field_of(row_, ends_, column));
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

bool ForeignTable::next(LineReader& reader, bool report) {
  while (reader.next()) {
    row_ = reader.line();
    split_at_commas(row_, ends_);
    if (ends_.size() == header_.size()) return true;
    if (trimmed(row_).empty() || !report) continue;
    const bool more = ends_.size() > header_.size();
    faults_.add(name_, "rows with a wrong number of fields", reader.number(),
                std::to_string(ends_.size()) + " fields where the header has " +
                    std::to_string(header_.size()) + (more ? " (a decimal comma?): " : ": ") + excerpt(row_));
  }
  return false;
}

double ForeignTable::number(const LineReader& reader, std::size_t column, bool report) {
  std::string kind;
  std::string what;
  const auto text = field(column);
  const double value = finite_number(text, kind, what);
  if (std::isnan(value) && report) {
    faults_.add(name_, kind, reader.number(), excerpt(text) + " in column `" + header_[column] + "` " + what);
  }
  return value;
}

void ForeignTable::collect_times(LineReader& reader) {
  std::string before;
  bool any = false;
  while (next(reader, true)) {
    any = true;
    if (!time_column_ || field(*time_column_) == before) continue;
    before = field(*time_column_);
    const double time = number(reader, *time_column_, true);
    if (!std::isnan(time) && (times_.empty() || time != times_.back())) times_.push_back(time);
  }
  if (!reader.has_end()) note("the last line has no end: is the file whole?");
  if (!time_column_ && any) times_ = {*only_time_};
  std::sort(times_.begin(), times_.end());
  times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
  if (times_.empty()) {
    fault("empty files", "there is no row with a readable time below the header");
    usable_ = false;
  }
}

std::vector<ParticleBlock> ForeignTable::read(std::span<const double> times) {
  std::vector<ParticleBlock> blocks(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    blocks[i].time = times[i];
    blocks[i].values.resize(fields_.size());
  }
  const auto block_at = [&](double time) {
    const auto at = std::lower_bound(times.begin(), times.end(), time);
    return at == times.end() || *at != time ? nullptr : &blocks[static_cast<std::size_t>(at - times.begin())];
  };
  LineReader reader(path_);
  reader.next();
  std::string before;
  ParticleBlock* block = time_column_ ? nullptr : block_at(*only_time_);
  while (next(reader, false)) {
    if (time_column_ && field(*time_column_) != before) {
      before = field(*time_column_);
      block = block_at(number(reader, *time_column_, false));  // NaN is nowhere
    }
    if (block == nullptr) continue;
    const double X = number(reader, X_column_, true);
    if (std::isnan(X)) continue;
    block->X.push_back(X);
    for (std::size_t f = 0; f < fields_.size(); ++f) {
      block->values[f].push_back(number(reader, columns_[f], true));
    }
  }
  for (auto& b : blocks) sort(b);
  return blocks;
}

void ForeignTable::sort(ParticleBlock& block) {
  std::vector<std::size_t> order(block.X.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return block.X[a] < block.X[b]; });
  const auto repeated = std::unique(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (block.X[a] != block.X[b]) return false;
    fault("particles there twice",
          "a particle with X = " + to_text(block.X[b]) + " is there twice at time " + to_text(block.time));
    return true;
  });
  order.erase(repeated, order.end());
  const auto reorder = [&](std::vector<double>& values) {
    std::vector<double> sorted;
    sorted.reserve(order.size());
    for (const std::size_t i : order) sorted.push_back(values[i]);
    values = std::move(sorted);
  };
  for (auto& values : block.values) reorder(values);
  reorder(block.X);
}

}  // namespace hompm::detail
