#include <algorithm>
#include <charconv>
#include <cmath>

#include <hompm/verify/csv_table.hpp>
#include <hompm/verify/csv_text.hpp>
#include <hompm/verify/excerpt.hpp>

namespace hompm::detail {

CsvTable::CsvTable(const std::filesystem::path& path, std::span<const std::string> fields,
                   bool with_particles, MessageLog& faults, MessageLog& notes)
    : name_(path.string()), reader_(path), faults_(faults), notes_(notes), columns_(fields.size()) {
  read_header(fields, with_particles);
}

void CsvTable::fault(const std::string& kind, std::int64_t line, const std::string& text) {
  faults_.add(name_, kind, line, text);
}

void CsvTable::note(const std::string& kind, std::int64_t line, const std::string& text) {
  notes_.add(name_, kind, line, text);
}

void CsvTable::read_header(std::span<const std::string> fields, bool with_particles) {
  if (!reader_.next()) {
    fault("empty files", 0, "the file is empty");
    return;
  }
  CsvRow row;
  row.text = reader_.line();
  split_at_commas(row.text, row.ends);
  if (const std::string other = other_separator(row.text); !other.empty())
    fault("other separators", 1, other);
  for (std::size_t i = 0; i < row.ends.size(); ++i) header_.emplace_back(row.field(i));

  std::vector<std::string> expected{"time"};
  if (with_particles) expected.emplace_back("particle");
  expected.insert(expected.end(), fields.begin(), fields.end());
  std::vector<std::optional<std::size_t>> found;
  for (const auto& column : expected) {
    const auto at = std::find(header_.begin(), header_.end(), column);
    if (at == header_.end()) {
      found.emplace_back();
      fault("missing columns", 1, "the column `" + column + "` is missing");
    } else {
      found.emplace_back(at - header_.begin());
    }
  }
  for (std::size_t i = 0; i < header_.size(); ++i) {
    if (with_particles && header_[i] == "body") continue;  // follows from the particle
    if (std::find(expected.begin(), expected.end(), header_[i]) == expected.end()) {
      fault("unknown columns", 1, "the column " + excerpt(header_[i]) + " is unknown and not compared");
    } else if (std::find(header_.begin(), header_.begin() + static_cast<std::ptrdiff_t>(i), header_[i]) !=
               header_.begin() + static_cast<std::ptrdiff_t>(i)) {
      fault("repeated columns", 1, "the column `" + header_[i] + "` is there twice");
    }
  }
  if (std::is_permutation(header_.begin(), header_.end(), expected.begin(), expected.end()) &&
      header_ != expected) {
    note("column orders", 1, "the columns are in another order than this version writes");
  }
  if (reader_.has_carriage_return()) note("line ends", 1, "the lines end in CRLF");

  std::copy(found.end() - static_cast<std::ptrdiff_t>(fields.size()), found.end(), columns_.begin());
  has_keys_ = found[0].has_value() && (!with_particles || found[1].has_value());
  time_column_ = found[0].value_or(0);
  if (with_particles) particle_column_ = found[1];
}

bool CsvTable::next(CsvRow& row) {
  while (reader_.next()) {
    row.line = reader_.number();
    row.text.assign(reader_.line());
    split_at_commas(row.text, row.ends);
    if (!reader_.has_end()) fault("cut lines", row.line, "the file is cut off: the last line has no end");
    if (row.ends.size() != header_.size()) {
      const bool more = row.ends.size() > header_.size();
      fault("rows with a wrong number of fields", row.line,
            std::to_string(row.ends.size()) + " fields where the header has " +
                std::to_string(header_.size()) + (more ? " (a decimal comma?): " : ": ") + excerpt(row.text));
    } else if (read_key(row)) {
      return true;
    }
  }
  return false;
}

bool CsvTable::read_key(CsvRow& row) {
  const auto time = row.field(time_column_);
  if (time != time_text_) {
    time_text_ = time;
    time_ = number(time, "time", row.line);
  } else if (std::isnan(time_)) {
    number(time, "time", row.line);
  }
  row.key = {time_, -1};
  if (particle_column_) {
    const auto text = row.field(*particle_column_);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), row.key.particle);
    if (error != std::errc{} || end != text.data() + text.size() || row.key.particle < 0) {
      fault("unreadable particle numbers", row.line,
            excerpt(text) + " in column `particle` is not a particle number");
      return false;
    }
  }
  return !std::isnan(time_);
}

double CsvTable::value(const CsvRow& row, std::size_t field) {
  const std::size_t column = *columns_[field];
  return number(row.field(column), header_[column], row.line);
}

double CsvTable::number(std::string_view text, const std::string& column, std::int64_t line) {
  std::string kind;
  std::string what;
  const double value = finite_number(text, kind, what);
  if (std::isnan(value)) fault(kind, line, excerpt(text) + " in column `" + column + "` " + what);
  return value;
}

}  // namespace hompm::detail
