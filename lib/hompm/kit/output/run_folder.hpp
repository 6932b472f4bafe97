// The folder a run leaves behind. Files appear whole or not at all: everything is written to a staging folder
// inside the output folder and renamed into place when the run has ended well.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include <hompm/simulation/records.hpp>

namespace hompm {

/// The file in a run folder from which a run that was stopped goes on (recorder/checkpoint.hpp).
inline constexpr const char* checkpoint_name = "checkpoint.hompm";

/// Writes particles.csv, stress.csv, history.csv, whole files by name and, where asked for,
/// vtk/snapshot_*.vtu with run.pvd. A write past a file size limit is a `FileError` only where the process
/// ignores SIGXFSZ.
class RunFolder {
 public:
  /// Creates `folder` (and its parents) and a staging folder inside it; nobody else can write there as long
  /// as the object lives. Throws `FileError` naming the path and the reason when that is impossible, or
  /// somebody else is writing there. With `vtk`, snapshots are also written as vtk/*.vtu with run.pvd. The
  /// first snapshot says whether there is a column `body`, and which fields are reported beside the usual.
  RunFolder(std::filesystem::path folder, bool vtk);
  /// Removes what `publish` did not move into place, and the folders the constructor created if they are
  /// empty.
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  /// Appends to particles.csv and stress.csv and writes one .vtu. Throws `FileError` when the disk is full,
  /// and `Error` naming field and particle when a value is not finite.
  void write(const Snapshot& snapshot);
  /// Appends to history.csv. Throws as above.
  void write(const HistoryRow& row);
  /// Appends rows to probes.csv, which is there with the first. Throws `FileError`.
  void write_probes(std::string_view rows);
  /// Writes a whole file, for scene.toml, run.json, timing.json; `name` has no folder in it. Throws
  /// `FileError`.
  void write(const std::string& name, const std::string& text);

  /// Where somebody else writes the file `name` of this run, whole before `publish` or `keep_invalid`; the
  /// latter leaves steps.csv.
  [[nodiscard]] std::filesystem::path add(const std::string& name);

  /// A file that an earlier run left in the folder, run.json if there is one; "" where there is none. A
  /// checkpoint counts for nothing.
  [[nodiscard]] std::string earlier_run() const;

  /// Puts a checkpoint into the folder at once, whole and on the disk, over an older one; `publish` and
  /// `keep_invalid` remove it as the last thing they do. Throws `FileError`: the older one is then untouched,
  /// and the run can go on.
  void write_checkpoint(std::string_view bytes);

  /// Ends a run that stopped being valid: removes what an earlier run left, so that nothing there looks like
  /// the result of this one, and leaves invalid/last_valid.csv (columns of particles.csv and stress.csv) and
  /// invalid/reason.txt. `publish` is refused from now on. Throws `FileError`, and `Error` when `last` is not
  /// finite.
  void keep_invalid(const Snapshot& last, const std::string& reason);

  /// Removes what an earlier run left under names of its own, run.json first, then renames all files into
  /// place, run.json last: a folder with a run.json holds one complete run. Files of other names are not
  /// touched. The checkpoint goes, unless it is to stay. Throws `FileError`; `Error` when an earlier call
  /// failed, for what is there is then not a whole run.
  void publish(bool keep_checkpoint = false);
  /// Replaces a whole file of the run that was published by this object, at once. Throws `FileError`: the
  /// older one is then untouched.
  void replace(const std::string& name, const std::string& text);

  [[nodiscard]] const std::filesystem::path& path() const;

 private:
  class Contents;
  std::unique_ptr<Contents> contents_;
};

}  // namespace hompm
