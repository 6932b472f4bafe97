#include <algorithm>
#include <cerrno>
#include <cmath>
#include <optional>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/kit/output/csv.hpp>
#include <hompm/kit/output/run_folder.hpp>
#include <hompm/kit/output/staging.hpp>
#include <hompm/number.hpp>

namespace hompm {
namespace {

namespace fs = std::filesystem;

/// Everything a run may leave in its folder, but for the snapshots in vtk/; run.json first, so that a folder
/// in which removing was cut short does not look complete.
constexpr const char* own_names[] = {"run.json",      "timing.json",        "scene.toml",
                                     "particles.csv", "stress.csv",         "history.csv",
                                     "run.pvd",       "invalid/reason.txt", "invalid/last_valid.csv",
                                     "probes.csv",    "steps.csv"};

void remove_file(const fs::path& path) {
  if (::unlink(path.c_str()) != 0 && errno != ENOENT && errno != ENOTDIR)
    throw FileError("replace", path, errno);
}

bool is_snapshot_name(std::string_view name) {
  constexpr std::string_view front = "snapshot_", back = ".vtu";
  if (!name.starts_with(front) || !name.ends_with(back) || name.size() <= front.size() + back.size())
    return false;
  const auto number = name.substr(front.size(), name.size() - front.size() - back.size());
  return std::all_of(number.begin(), number.end(), [](char c) { return '0' <= c && c <= '9'; });
}

void remove_earlier_run(const fs::path& folder) {
  for (const char* name : own_names) remove_file(folder / name);
  std::vector<fs::path> snapshots;
  std::error_code error;
  for (fs::directory_iterator entry(folder / "vtk", error), end; !error && entry != end;
       entry.increment(error)) {
    if (is_snapshot_name(entry->path().filename().string())) snapshots.push_back(entry->path());
  }
  const bool no_folder = error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory;
  if (error && !no_folder) throw FileError("read", folder / "vtk", error.value());
  for (const auto& snapshot : snapshots) remove_file(snapshot);
  for (const char* name : {"vtk", "invalid"}) ::rmdir((folder / name).c_str());  // stays when it is not empty
}

/// Looked at before anything is written, so that a bad snapshot leaves the files as they were.
void check(const Snapshot& snapshot) {
  const auto at = [&] { return " at time " + to_text(snapshot.time); };
  const auto check_values = [&](std::string_view name, const std::vector<double>& values) {
    if (values.size() != snapshot.size())
      throw Error("the snapshot" + at() + " has " + std::to_string(values.size()) + " values of " +
                  std::string(name) + " for " + std::to_string(snapshot.size()) + " particles");
    const auto bad =
        std::find_if_not(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    if (bad != values.end())
      throw Error(std::string(name) + " of particle " + std::to_string(bad - values.begin()) + at() +
                  " is not finite and cannot be written");
  };
  for (const auto& column : detail::all_columns) check_values(column.name, snapshot.*column.values);
  for (const auto& field : snapshot.reported) check_values(field.name, field.values);
}

void check(const HistoryRow& row) {
  for (const auto& column : detail::history_columns) {
    if (!std::isfinite(row.*column.value)) {
      throw Error(std::string(column.name) + " at time " + to_text(row.time) +
                  " is not finite and cannot be written");
    }
  }
}

}  // namespace

class RunFolder::Contents {
 public:
  Contents(fs::path folder, bool vtk) : staging(std::move(folder)), with_vtk(vtk) {}

  detail::StagingFolder staging;
  detail::TextFile particles = staging.create("particles.csv");
  detail::TextFile stress = staging.create("stress.csv");
  detail::TextFile history = staging.create("history.csv");
  std::optional<detail::TextFile> probes;
  bool with_vtk;
  std::vector<double> vtk_times;
  bool whole = true;  // no write failed half-way
  bool headed = false;

  void write_headers(const Snapshot& first) {
    if (std::exchange(headed, true)) return;
    write_header(particles, detail::particle_columns, !first.body.empty(), first.reported);
    write_header(stress, detail::stress_columns, !first.body.empty());
  }

  /// Does `work`; should it throw, the files are no longer a whole run.
  template <class Work>
  void change(Work work) {
    if (!whole) throw Error("the run in " + staging.path().string() + " is not whole and takes no more data");
    whole = false;
    work();
    whole = true;
  }
};

RunFolder::RunFolder(fs::path folder, bool vtk)
    : contents_(std::make_unique<Contents>(std::move(folder), vtk)) {
  write_history_header(contents_->history);
}

RunFolder::~RunFolder() = default;

const fs::path& RunFolder::path() const { return contents_->staging.path(); }

void RunFolder::write(const Snapshot& snapshot) {
  check(snapshot);
  contents_->change([&] {
    contents_->write_headers(snapshot);
    write_rows(contents_->particles, detail::particle_columns, snapshot, snapshot.reported);
    write_rows(contents_->stress, detail::stress_columns, snapshot);
    if (!contents_->with_vtk) return;
    auto file = contents_->staging.create(detail::vtu_name(contents_->vtk_times.size()));
    write_vtu(file, snapshot);
    file.close();
    contents_->vtk_times.push_back(snapshot.time);
  });
}

void RunFolder::write(const HistoryRow& row) {
  check(row);
  contents_->change([&] { write_history_row(contents_->history, row); });
}

void RunFolder::write_probes(std::string_view rows) {
  if (rows.empty()) return;
  contents_->change([&] {
    auto& file = contents_->probes;
    if (!file) {
      file.emplace(contents_->staging.add("probes.csv"), path() / "probes.csv");
      *file << detail::probe_header();
    }
    *file << rows;
  });
}

void RunFolder::write(const std::string& name, const std::string& text) {
  contents_->change([&] {
    auto file = contents_->staging.create(name);
    file << text;
    file.close();
  });
}

fs::path RunFolder::add(const std::string& name) { return contents_->staging.add(name); }

std::string RunFolder::earlier_run() const {
  std::error_code ignored;
  for (const char* name : own_names)
    if (fs::exists(fs::symlink_status(path() / name, ignored))) return name;
  return "";
}

void RunFolder::write_checkpoint(std::string_view bytes) {
  contents_->staging.replace(checkpoint_name, bytes);
}

void RunFolder::replace(const std::string& name, const std::string& text) {
  contents_->staging.replace(name, text);
}

void RunFolder::keep_invalid(const Snapshot& last, const std::string& reason) {
  check(last);
  contents_->whole = false;
  auto& staging = contents_->staging;
  auto rows = staging.create("invalid/last_valid.csv");
  write_header(rows, detail::all_columns, !last.body.empty(), last.reported);
  write_rows(rows, detail::all_columns, last, last.reported);
  rows.close();
  auto text = staging.create("invalid/reason.txt");
  text << reason << "\n";
  text.close();
  remove_earlier_run(staging.path());
  staging.move_into_place("invalid/last_valid.csv");
  staging.move_into_place("invalid/reason.txt");
  if (staging.names().contains("steps.csv")) staging.move_into_place("steps.csv");
  remove_file(staging.path() / checkpoint_name);
}

void RunFolder::publish(bool keep_checkpoint) {
  auto& staging = contents_->staging;
  contents_->change([&] {
    contents_->write_headers({});
    contents_->particles.close();
    contents_->stress.close();
    contents_->history.close();
    if (contents_->probes) contents_->probes->close();
    if (contents_->with_vtk) {
      auto file = staging.create("run.pvd");
      write_pvd(file, contents_->vtk_times);
      file.close();
    }
    remove_earlier_run(staging.path());
    auto names = staging.names();
    const bool has_summary = names.erase("run.json") > 0;
    for (const auto& name : names) staging.move_into_place(name);
    if (has_summary) staging.move_into_place("run.json");
    if (!keep_checkpoint)
      remove_file(staging.path() / checkpoint_name);  // last: until here a kill must find it
  });
  contents_->whole = false;  // published: nothing more to write
}

}  // namespace hompm
