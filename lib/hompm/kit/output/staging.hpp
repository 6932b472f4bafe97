// Files that do not exist for anybody else until they are moved into place, in a folder that one process has.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <hompm/kit/output/text_file.hpp>

namespace hompm::detail {

/// An exclusive lock on a folder (flock of a hidden file in it, which also network file systems can do), for
/// as long as the object lives and at most as the process does. It keeps nobody out who does not ask.
class FolderLock {
 public:
  /// Throws `FileError` where the file cannot be had, and where somebody else holds it, for whom it otherwise
  /// `waits`. On a file system without locks everybody holds it.
  explicit FolderLock(const std::filesystem::path& folder, bool waits = false);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Nobody else can hold it.
  [[nodiscard]] bool exclusive() const { return exclusive_; }

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
  bool exclusive_ = false;
};

/// Creates missing folders and removes them again, as far as they are still empty, when it goes.
class CreatedFolders {
 public:
  /// Creates `folder` and what is missing above it. Throws `FileError`, leaving nothing behind.
  explicit CreatedFolders(const std::filesystem::path& folder);
  ~CreatedFolders();
  CreatedFolders(const CreatedFolders&) = delete;
  CreatedFolders& operator=(const CreatedFolders&) = delete;

 private:
  void remove_empty();
  std::vector<std::filesystem::path> created_;
};

/// A folder, which nobody else can have as long as the object lives, and inside it the hidden one in which
/// files wait to be moved; the latter goes with the object.
class StagingFolder {
 public:
  /// Removes what killed runs left over. Throws `FileError` when one of the two folders cannot be created,
  /// and when another process has the folder, for which it otherwise `waits`.
  explicit StagingFolder(std::filesystem::path folder, bool waits = false);
  ~StagingFolder();
  StagingFolder(const StagingFolder&) = delete;
  StagingFolder& operator=(const StagingFolder&) = delete;

  /// A new file waiting under `name`, which is relative to the folder and may have one folder in front.
  /// Throws `FileError`.
  TextFile create(const std::string& name);
  /// The same, for somebody else to create: the path at which it waits.
  std::filesystem::path add(const std::string& name);
  /// Moves the (closed) file `name` to its place, over an older one. Throws `FileError`.
  void move_into_place(const std::string& name);
  /// Puts a file with this content in its place, all of it on the disk before it replaces an older one.
  /// Throws `FileError`, the older one then untouched.
  void replace(const std::string& name, std::string_view content);

  /// Names of the files still waiting.
  [[nodiscard]] const std::set<std::string>& names() const { return names_; }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path folder_;
  CreatedFolders created_;
  FolderLock lock_;
  std::filesystem::path staging_;
  std::set<std::string> names_;
};

/// Writes a file so that it is there whole or not at all, creating its folder, and waits for whoever else
/// writes there; into what is no regular file (a device, a pipe) as it is. Throws `FileError`.
void write_whole(const std::filesystem::path& path, std::string_view text);

}  // namespace hompm::detail
