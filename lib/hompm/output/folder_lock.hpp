// Keeps two processes from writing into one folder.
#pragma once

#include <filesystem>

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

}  // namespace hompm::detail
