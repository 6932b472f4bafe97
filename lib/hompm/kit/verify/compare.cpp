#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <limits>
#include <sstream>
#include <string_view>
#include <utility>

#include <hompm/error.hpp>
#include <hompm/kit/verify/compare.hpp>
#include <hompm/kit/verify/table_comparison.hpp>
#include <hompm/simulation/records.hpp>

namespace hompm {
namespace {

namespace fs = std::filesystem;

/// One results file and its fields.
struct ResultsFile {
  std::string name;
  bool has_particles;
  std::vector<std::string> fields;
};

template <class Columns>
std::vector<std::string> names(const Columns& columns) {
  std::vector<std::string> all;
  all.reserve(columns.size());
  for (const auto& column : columns) all.emplace_back(column.name);
  return all;
}

const std::array<ResultsFile, 3>& tables() {
  static const std::array<ResultsFile, 3> all{
      ResultsFile{"particles.csv", true, names(detail::particle_columns)},
      ResultsFile{"stress.csv", true, names(detail::stress_columns)},
      ResultsFile{"history.csv", false, names(detail::history_columns)}};
  return all;
}

/// The columns of a file that are fields, beyond the usual ones.
std::vector<std::string> further_columns(const fs::path& path, const ResultsFile& table) {
  detail::LineReader reader(path);
  std::vector<std::string> further, known = table.fields;
  if (!table.has_particles || !reader.next()) return further;
  known.insert(known.end(), {"time", "particle", "body"});
  std::istringstream header{std::string(reader.line())};
  for (std::string name; std::getline(header, name, ',');) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    further.push_back(name);
    known.push_back(name);
  }
  return further;
}

/// The table with the fields that effects and laws report in both files.
ResultsFile with_reported(ResultsFile table, const fs::path& a, const fs::path& b) {
  const auto others = further_columns(b, table);
  for (const std::string& name : further_columns(a, table))
    if (std::find(others.begin(), others.end(), name) != others.end()) table.fields.push_back(name);
  return table;
}

/// Throws `FileError` when the answer cannot be had.
bool is_there(const fs::path& path) {
  std::error_code error;
  const bool found = fs::exists(path, error);
  if (error) throw FileError("read", path, error.value());
  return found;
}

void require_folder(const fs::path& path) {
  if (!is_there(path)) throw FileError("read", path, ENOENT);
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) throw FileError("read", path, ENOTDIR);
}

std::vector<Tolerance> tolerances_of(const ResultsFile& table,
                                     const std::map<std::string, Tolerance>& tolerances) {
  std::vector<Tolerance> all;
  for (const auto& field : table.fields) {
    const auto found = tolerances.find(field);
    all.push_back(found == tolerances.end() ? Tolerance{} : found->second);
  }
  return all;
}

std::string shown(bool has_line, std::string_view line) {
  return has_line ? detail::excerpt(line) : "the end of the file";
}

}  // namespace

std::string to_string(Verdict verdict) {
  return std::array{"identical", "equivalent", "different"}[static_cast<std::size_t>(verdict)];
}

std::uint64_t ulp_distance(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<std::uint64_t>::max();
  const auto x = detail::ordered_bits(a);
  const auto y = detail::ordered_bits(b);
  return x < y ? y - x : x - y;
}

const std::vector<std::string>& compared_fields() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> fields;
    for (const auto& table : tables()) {
      for (const auto& field : table.fields) {
        if (std::find(fields.begin(), fields.end(), field) == fields.end()) fields.push_back(field);
      }
    }
    return fields;
  }();
  return all;
}

Comparison compare_folders(const fs::path& a, const fs::path& b,
                           const std::map<std::string, Tolerance>& tolerances, bool more_times) {
  const auto& known = compared_fields();
  for (const auto& [field, tolerance] : tolerances) {
    if (std::find(known.begin(), known.end(), field) == known.end())
      throw Error("no field is called " + field);
  }
  require_folder(a);
  require_folder(b);

  Comparison result;
  detail::MessageLog faults;
  detail::MessageLog notes;
  std::optional<Difference> first;  // of all, within a tolerance or not
  bool any_in_a = false;
  bool any_in_b = false;
  for (const auto& usual : tables()) {
    const fs::path file_a = a / usual.name;
    const fs::path file_b = b / usual.name;
    const bool in_a = is_there(file_a);
    const bool in_b = is_there(file_b);
    any_in_a = any_in_a || in_a;
    any_in_b = any_in_b || in_b;
    if (in_a != in_b) {
      const auto& [there, missing] = in_a ? std::pair(file_a, file_b) : std::pair(file_b, file_a);
      faults.add(missing.string(), "missing files", 0, "missing, but there is " + there.string());
    }
    if (!in_a || !in_b) continue;
    const ResultsFile table = with_reported(usual, file_a, file_b);
    const detail::TableLayout layout{.fields = table.fields, .with_particles = table.has_particles};
    detail::Table table_a(file_a, layout, faults, notes);
    detail::Table table_b(file_b, layout, faults, notes);
    if (!table_a.has_keys() || !table_b.has_keys()) continue;
    detail::FieldJudge judge(table.name, table.fields, tolerances_of(table, tolerances));
    compare_tables(table_a, table_b, table.fields.size(), judge, more_times);
    result.fields.insert(result.fields.end(), judge.fields().begin(), judge.fields().end());
    if (!first) first = judge.first();
    if (!result.first) result.first = judge.first_beyond();
  }
  for (const auto& [any, folder] : {std::pair(any_in_a, a), std::pair(any_in_b, b)})
    if (!any) throw FileError(folder.string() + " holds no particles.csv, stress.csv or history.csv");

  if (!result.first) result.first = first;
  result.messages = faults.messages();
  result.notes = notes.messages();
  const auto any = [&](auto count) {
    return std::any_of(result.fields.begin(), result.fields.end(),
                       [&](const auto& f) { return f.*count > 0; });
  };
  if (!result.messages.empty() || any(&FieldComparison::beyond))
    result.verdict = Verdict::different;
  else if (any(&FieldComparison::differing))
    result.verdict = Verdict::equivalent;
  return result;
}

std::pair<std::string, std::string> detail::first_different_lines(const std::string& a,
                                                                  const std::string& b) {
  std::istringstream in_a(a);
  std::istringstream in_b(b);
  std::pair<std::string, std::string> lines;
  while (lines.first == lines.second && (in_a || in_b)) {
    if (!std::getline(in_a, lines.first)) lines.first = "nothing more";
    if (!std::getline(in_b, lines.second)) lines.second = "nothing more";
  }
  return lines;
}

void compare_scenes(const fs::path& a, const fs::path& b, Comparison& comparison) {
  const char* const name = "scene.toml";
  if (!is_there(a / name) || !is_there(b / name)) return;
  detail::LineReader reader_a(a / name);
  detail::LineReader reader_b(b / name);
  while (true) {
    const bool more_a = reader_a.next();
    const bool more_b = reader_b.next();
    if (!more_a && !more_b) return;
    if (more_a && more_b && reader_a.line() == reader_b.line()) continue;
    const auto line = more_a ? reader_a.number() : reader_b.number();
    comparison.messages.push_back("scene.toml differs at line " + std::to_string(line) + ": " +
                                  shown(more_a, reader_a.line()) + " against " +
                                  shown(more_b, reader_b.line()));
    comparison.verdict = Verdict::different;
    return;
  }
}

}  // namespace hompm
