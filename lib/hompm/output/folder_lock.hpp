// Tells whether another process is at work in a folder.
#pragma once

#include <filesystem>

namespace hompm::detail {

/// An exclusive lock on a folder (flock), for as long as the object lives and at most as the process does. It
/// keeps nobody out who does not ask.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;

  /// This object holds the lock, and the folder is still in its place.
  [[nodiscard]] bool held() const { return held_; }
  /// Somebody else holds it. Neither this nor `held` where the file system knows no locks.
  [[nodiscard]] bool taken() const { return taken_; }

 private:
  int descriptor_;
  bool held_ = false;
  bool taken_ = false;
};

}  // namespace hompm::detail
