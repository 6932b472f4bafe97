#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/verify/table.hpp>

namespace hompm::detail {
namespace {

void split_at_commas(std::string_view text, std::vector<std::size_t>& ends) {
  ends.clear();
  for (auto comma = text.find(','); comma != text.npos; comma = text.find(',', comma + 1))
    ends.push_back(comma);
  ends.push_back(text.size());
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

char separator_of(std::string_view line) {
  for (const char separator : {';', ','})
    if (line.find(separator) != line.npos) return separator;
  return ' ';
}

/// The line with commas between its fields. Where blanks separate them, "stress [Pa]" is one.
std::string with_commas(std::string_view line, char separator) {
  std::string text(line);
  if (separator == ';') {
    std::ranges::replace(text, ',', '.');
    std::ranges::replace(text, ';', ',');
  } else if (separator == ' ') {
    text.clear();
    for (const char c : trimmed(line)) {
      const bool blank = c == ' ' || c == '\t';
      if ((c == '[' || c == '(') && text.ends_with(',')) text.pop_back();
      if (!blank || !text.ends_with(',')) text += blank ? ',' : c;
    }
  }
  return text;
}

/// The number in `text`. NaN when it is not a finite one; `kind` and `fault` then say what it is, in the
/// words of `MessageLog`: "values that are not numbers", "is not a number".
double finite_number(std::string_view text, std::string& kind, std::string& fault) {
  double value = 0.0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error == std::errc{} && end == last && std::isfinite(value)) return value;
  if (end != last || error == std::errc::invalid_argument) {
    kind = "values that are not numbers";
    fault = "is not a number";
  } else if (error == std::errc::result_out_of_range) {
    kind = "values out of range";
    fault = "is beyond the range of a double";
  } else {
    kind = "values that are not finite";
    fault = "is not finite";
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// The same with blanks around it, a plus sign, and the exponents of Fortran: 1.5D-3.
double lenient_number(std::string_view text, std::string& kind, std::string& fault) {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const auto exponent = text.find_first_of("dD");
  if (exponent == text.npos || exponent == 0 || text.find_first_of("nN") != text.npos)
    return finite_number(text, kind, fault);
  std::string usual(text);
  usual[exponent] = 'e';
  return finite_number(usual, kind, fault);
}

/// The number of fields of a line with commas, and whether the first is a number.
std::pair<std::size_t, bool> shape_of(const std::string& line) {
  std::string ignored;
  return {static_cast<std::size_t>(std::ranges::count(line, ',')) + 1,
          !std::isnan(lenient_number(line.substr(0, line.find(',')), ignored, ignored))};
}

std::string lower(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

/// A column's name without quotes, and its unit without brackets.
std::pair<std::string_view, std::string_view> name_and_unit(std::string_view header) {
  auto name = trimmed(header);
  if (name.size() > 1 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  const auto bracket = name.find_last_of("[(");
  const bool closed = name.ends_with(']') || name.ends_with(')');
  if (bracket == name.npos || bracket == 0 || !closed) return {name, {}};
  return {trimmed(name.substr(0, bracket)), trimmed(name.substr(bracket + 1, name.size() - bracket - 2))};
}

struct Unit {
  std::string_view name;
  double times = 1.0;
  double over = 1.0;
};
/// Names of SI units, which need no factor.
constexpr std::array<std::string_view, 14> si_units{
    "", "-", "1", "m", "s", "m/s", "Pa", "N/m^2", "N/m2", "kg/m^3", "kg/m3", "kg/m\u00b3", "m^3", "m3"};
constexpr std::array<Unit, 19> units{{{"km", 1e3},
                                      {"cm", 1.0, 1e2},
                                      {"mm", 1.0, 1e3},
                                      {"um", 1.0, 1e6},
                                      {"\u00b5m", 1.0, 1e6},
                                      {"min", 60.0},
                                      {"ms", 1.0, 1e3},
                                      {"us", 1.0, 1e6},
                                      {"\u00b5s", 1.0, 1e6},
                                      {"km/s", 1e3},
                                      {"cm/s", 1.0, 1e2},
                                      {"mm/s", 1.0, 1e3},
                                      {"kPa", 1e3},
                                      {"MPa", 1e6},
                                      {"N/mm^2", 1e6},
                                      {"GPa", 1e9},
                                      {"bar", 1e5},
                                      {"g/cm^3", 1e3},
                                      {"g/cm3", 1e3}}};

/// The field that others call `name`, or "". Directions are told by letter or number.
std::string known_as(std::string_view name, char direction) {
  const std::string d(1, direction);
  const std::string k(1, static_cast<char>('1' + (direction - 'x')));
  if (name == d) return "x";
  if (name.size() == 1 && lower(name) == d) return "X";
  const std::string word = lower(name);
  const std::vector<std::pair<std::string, std::vector<std::string>>> names{
      {"time", {"time", "t", "timevalue"}},
      {"X", {d + "0", d + "_0", d + "_ref", "reference_position", "initial_position"}},
      {"x", {"pos", "position", "pos_" + d, "pos" + d, "coordinate"}},
      {"displacement",
       {"displacement", "u", "u" + d, "u_" + d, "u" + k, "displacement_" + d, "displacement" + d}},
      {"velocity", {"velocity", "v", "vel", "v" + d, "v_" + d, "v" + k, "vel_" + d, "velocity_" + d}},
      {"volume", {"volume", "vol"}},
      {"density", {"density", "rho"}},
      {"stress",
       {"stress", "sigma", "s", "sig", "s" + k + k, "s" + d + d, "s_" + d + d, "sigma" + k + k,
        "sigma_" + d + d, "sigma" + d + d, "stress_" + d + d, "stress" + d + d}},
      {"stretch", {"stretch", "lambda", "f", "f" + k + k, "f" + d + d}},
      {"particle", {"particle", "id", "particle_id"}},
      {"body", {"body"}}};
  for (const auto& [field, aliases] : names)
    if (std::ranges::find(aliases, word) != aliases.end()) return field;
  return "";
}

}  // namespace

LineReader::LineReader(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code ignored;
  if (std::filesystem::exists(path_, ignored) && !std::filesystem::is_regular_file(path_, ignored))
    throw FileError("cannot read " + path_.string() + ": not a regular file");
  file_.open(path_, std::ios::binary);
  if (!file_) throw FileError("read", path_, errno);
}

bool LineReader::next() {
  file_.getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  if (file_.bad()) throw FileError("read", path_, errno);
  const auto length = static_cast<std::size_t>(file_.gcount());
  if (file_.eof() && length == 0) return false;
  if (file_.fail())
    throw FileError("cannot read " + path_.string() + ": line " + std::to_string(number_ + 1) +
                    " is longer than " + std::to_string(longest_line) + " characters");
  has_end_ = !file_.eof();
  line_ = {buffer_.data(), has_end_ ? length - 1 : length};
  ++number_;
  has_carriage_return_ = line_.ends_with('\r');
  if (has_carriage_return_) line_.remove_suffix(1);
  return true;
}

void LineReader::rewind() {
  file_.clear();
  if (!file_.seekg(0)) throw FileError("read", path_, errno);
  number_ = 0;
}

Table::Table(const std::filesystem::path& path, TableLayout layout, MessageLog& faults, MessageLog& notes)
    : layout_(std::move(layout)),
      name_(layout_.name.empty() ? path.string() : layout_.name),
      reader_(path),
      faults_(faults),
      notes_(notes),
      columns_(layout_.fields.size()) {
  layout_.lenient ? read_any_header() : read_our_header();
}

void Table::refuse(std::int64_t line, const std::string& text) const {
  throw FileError("cannot read " + name_ + (line > 0 ? " line " + std::to_string(line) : "") + ": " + text);
}

void Table::read_our_header() {
  if (!reader_.next()) return fault("empty files", 0, "the file is empty");
  Row row;
  cut(row);
  for (std::size_t i = 0; i < row.ends.size(); ++i) header_.emplace_back(row.field(i));
  for (const auto& [separator, name] :
       {std::pair(';', "semicolons"), std::pair('\t', "tabs"), std::pair(' ', "blanks")}) {
    if (header_.size() > 1 || row.text.find(separator) == row.text.npos) continue;
    fault("other separators", 1,
          std::string("the columns are separated by ") + name +
              ": commas between columns and points in numbers are needed");
    break;
  }

  std::vector<std::string> expected{"time"};
  if (layout_.with_particles) expected.emplace_back("particle");
  expected.insert(expected.end(), layout_.fields.begin(), layout_.fields.end());
  std::vector<std::optional<Column>> found;
  for (const auto& column : expected) {
    const auto at = std::ranges::find(header_, column);
    if (at == header_.end()) {
      found.emplace_back();
      fault("missing columns", 1, "the column `" + column + "` is missing");
    } else {
      found.push_back(Column{static_cast<std::size_t>(at - header_.begin())});
    }
  }
  for (auto name = header_.begin(); name != header_.end(); ++name) {
    if (layout_.with_particles && *name == "body") continue;  // follows from the particle
    if (std::ranges::find(expected, *name) == expected.end()) {
      fault("unknown columns", 1, "the column " + excerpt(*name) + " is unknown and not compared");
    } else if (std::find(header_.begin(), name, *name) != name) {
      fault("repeated columns", 1, "the column `" + *name + "` is there twice");
    }
  }
  if (header_ != expected && std::ranges::is_permutation(header_, expected))
    note("column orders", 1, "the columns are in another order than this version writes");
  if (reader_.has_carriage_return()) note("line ends", 1, "the lines end in CRLF");

  std::copy(found.end() - static_cast<std::ptrdiff_t>(layout_.fields.size()), found.end(), columns_.begin());
  has_keys_ = found[0] && (!layout_.with_particles || found[1]);
  time_column_ = found[0].value_or(Column{});
  if (layout_.with_particles && found[1]) particle_column_ = found[1]->index;
}

void Table::read_any_header() {
  std::vector<std::string> comments;
  std::string header;
  std::string first_row;
  while (first_row.empty() && reader_.next()) {
    std::string_view line = reader_.line();
    if (reader_.number() == 1 && line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
    line = trimmed(line);
    const bool comment = line.starts_with('#') || line.starts_with('%');
    if (comment) line = trimmed(line.substr(1));
    if (line.empty()) continue;
    if (std::ranges::any_of(line, [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\t'; }))
      refuse(reader_.number(), "this is not text");
    if (comment) {
      comments.emplace_back(line);
    } else if (header.empty() && !shape_of(with_commas(line, separator_of(line))).second) {
      header = line;
    } else {
      first_row = line;
    }
    header_line_ = reader_.number() - (first_row.empty() ? 0 : 1);
  }
  at_row_ = !first_row.empty();
  if (header.empty()) {  // the names may be in a comment: the last one with as many as there are columns
    const auto width = shape_of(with_commas(first_row, separator_of(first_row))).first;
    for (const auto& comment : comments) {
      const bool fits = shape_of(with_commas(comment, separator_of(comment))).first == width;
      if (fits || first_row.empty()) header = comment;
    }
  }
  if (header.empty() && first_row.empty()) refuse(0, "the file is empty");

  separator_ = separator_of(first_row);
  const std::string names = with_commas(header, separator_of(header));
  const std::size_t count = shape_of(names).first;
  if (separator_ == ' ' && shape_of(with_commas(first_row, ' ')).first != count)
    separator_ = separator_of(header);
  if (header.empty()) {
    const auto width = shape_of(with_commas(first_row, separator_)).first;
    if (layout_.columns.empty())
      refuse(reader_.number(), "there is no header: --column X=1 --column time=2 … say which column is what");
    for (std::size_t i = 1; i <= width; ++i) header_.push_back(std::to_string(i));
  } else {
    Row row;
    row.text = names;
    split_at_commas(row.text, row.ends);
    for (std::size_t i = 0; i < row.ends.size(); ++i) header_.emplace_back(trimmed(row.field(i)));
  }
  find_columns();
}

Table::Column Table::column_of(std::size_t index, std::string_view unit) const {
  if (std::ranges::find(si_units, unit) != si_units.end()) return {index};
  const auto found = std::ranges::find(units, unit, &Unit::name);
  if (found != units.end()) return {index, found->times, found->over};
  std::string known = "m, s";
  for (const std::string_view name : si_units)
    if (name.size() > 1) known.append(", ").append(name);
  for (const Unit& other : units) known.append(", ").append(other.name);
  refuse(header_line_, "the unit " + excerpt(unit) + " of a column is unknown; known are " + known);
}

void Table::find_columns() {
  std::vector<std::string> wanted = layout_.fields;
  wanted.emplace_back("time");
  std::vector<std::optional<Column>> found(wanted.size());
  std::vector<std::size_t> rank(wanted.size(), 3);  // by what a field was found: --column, its name, another
  std::vector<bool> used(header_.size(), false);
  const auto asked = [&](const std::string& field, std::size_t i, std::string_view name) {
    const auto column = layout_.columns.find(field);
    if (column == layout_.columns.end()) return false;
    return column->second == name || column->second == header_[i] || column->second == std::to_string(i + 1);
  };
  for (std::size_t i = 0; i < header_.size(); ++i) {
    const auto [name, unit] = name_and_unit(header_[i]);
    const bool letter = name == "x" || name == "X";
    for (std::size_t f = 0; f < wanted.size(); ++f) {
      const bool same = name == wanted[f] && (layout_.direction == 'x' || !letter);
      const std::size_t by = asked(wanted[f], i, name)                        ? 0
                             : layout_.columns.contains(wanted[f])            ? 3
                             : same                                           ? 1
                             : known_as(name, layout_.direction) == wanted[f] ? 2
                                                                              : 3;
      if (by == 3 || by > rank[f]) continue;
      if (by == rank[f]) {
        const auto other = name_and_unit(header_[found[f]->index]).first;
        refuse(header_line_, name == other ? "the column `" + std::string(name) + "` is there twice"
                                           : "the columns " + excerpt(other) + " and " + excerpt(name) +
                                                 " may both be the " + wanted[f] + ": --column " + wanted[f] +
                                                 "=… says which");
      }
      if (found[f]) used[found[f]->index] = false;
      rank[f] = by;
      used[i] = true;
      found[f] = column_of(i, unit);
    }
  }
  for (const auto& [field, column] : layout_.columns) {
    const auto f = static_cast<std::size_t>(std::ranges::find(wanted, field) - wanted.begin());
    if (f < wanted.size() && rank[f] != 0)
      refuse(header_line_, "there is no column " + excerpt(column) + " to take for the " + field);
  }
  std::vector<std::string> missing;
  for (std::size_t f = 0; f < wanted.size(); ++f)
    if (!found[f]) missing.push_back(wanted[f]);
  std::string others;
  for (std::size_t i = 0; i < header_.size(); ++i) {
    if (used[i]) continue;
    const std::string name(name_and_unit(header_[i]).first);
    const std::string meant = name.size() < 3 ? "" : nearest(name, missing);
    if (!meant.empty()) lookalikes_.emplace_back(name, meant);
    others += (others.empty() ? "" : ", ") + excerpt(name) +
              (meant.empty() ? "" : " (did you mean " + meant + "?)");
  }
  if (!others.empty()) note("columns", 0, "columns not looked at: " + others);
  time_column_ = found.back();
  if (!time_column_ && !layout_.only_time)
    refuse(header_line_, "the column `time` is missing; --time T says which time of B the file is all at" +
                             (others.empty() ? "" : "; columns not looked at: " + others));
  found.pop_back();
  columns_ = std::move(found);
  has_keys_ = true;
}

bool Table::cut(Row& row) const {
  row.text.assign(reader_.line());
  if (layout_.lenient) {
    const auto content = trimmed(row.text);
    if (content.empty() || content[0] == '#' || content[0] == '%') return false;
    if (separator_ != ',') row.text = with_commas(row.text, separator_);
  }
  split_at_commas(row.text, row.ends);
  return true;
}

bool Table::next(Row& row) {
  while (std::exchange(at_row_, false) || reader_.next()) {
    row.line = reader_.number();
    if (!reader_.has_end() && layout_.lenient) {
      if (!repeating_) note("ends", 0, "the last line has no end: is the file whole?");
    } else if (!reader_.has_end()) {
      fault("cut lines", row.line, "the file is cut off: the last line has no end");
    }
    if (!cut(row)) continue;
    if (row.ends.size() == header_.size()) {
      if (read_key(row)) return true;
    } else if (!repeating_) {
      const bool more = row.ends.size() > header_.size();
      fault("rows with a wrong number of fields", row.line,
            std::to_string(row.ends.size()) + " fields where the header has " +
                std::to_string(header_.size()) + (more ? " (a decimal comma?): " : ": ") + excerpt(row.text));
    }
  }
  return false;
}

void Table::rewind() {
  reader_.rewind();
  while (reader_.number() < header_line_) reader_.next();
  at_row_ = false;
  repeating_ = true;
}

bool Table::read_key(Row& row) {
  if (!time_column_) {
    row.key = {*layout_.only_time, -1};
    return true;
  }
  const auto time = row.field(time_column_->index);
  if (time != time_text_ || (std::isnan(time_) && !repeating_)) {
    time_text_ = time;
    time_ = number(row, *time_column_);
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

double Table::value(const Row& row, std::size_t field) { return number(row, *columns_[field]); }

double Table::number(const Row& row, const Column& column) {
  std::string kind;
  std::string what;
  const auto text = row.field(column.index);
  const double value = layout_.lenient ? lenient_number(text, kind, what) : finite_number(text, kind, what);
  if (std::isnan(value) && !(repeating_ && time_column_ && column.index == time_column_->index))
    fault(kind, row.line,
          excerpt(layout_.lenient ? trimmed(text) : text) + " in column `" +
              std::string(name_and_unit(header_[column.index]).first) + "` " + what);
  return value * column.times / column.over;
}

}  // namespace hompm::detail
