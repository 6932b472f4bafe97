#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <string_view>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include <hompm/error.hpp>
#include <hompm/kit/output/staging.hpp>

namespace hompm::detail {

FolderLock::FolderLock(const std::filesystem::path& folder, bool waits) : file_(folder / ".hompm-lock") {
  for (;;) {
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor_ < 0) throw FileError("write in", folder, errno);
    exclusive_ = ::flock(descriptor_, waits ? LOCK_EX : LOCK_EX | LOCK_NB) == 0;
    const bool taken = !exclusive_ && errno == EWOULDBLOCK;
    struct stat locked {};
    struct stat named {};
    // The one who held it may have removed the file since it was opened: then it locks nothing.
    const bool there = ::fstat(descriptor_, &locked) == 0 && ::lstat(file_.c_str(), &named) == 0 &&
                       locked.st_dev == named.st_dev && locked.st_ino == named.st_ino;
    if (there && !taken) return;
    ::close(descriptor_);
    if (there)
      throw FileError("cannot write in " + folder.string() +
                      ": another run is writing there; wait for it, or choose another --output");
  }
}

FolderLock::~FolderLock() {
  ::unlink(file_.c_str());
  ::close(descriptor_);
}

namespace {

namespace fs = std::filesystem;

/// Creates one folder; false when it is there already. Throws `FileError`.
bool create_folder(const fs::path& folder) {
  if (::mkdir(folder.c_str(), 0777) == 0) return true;
  const int reason = errno;
  std::error_code ignored;
  if (fs::is_directory(folder, ignored)) return false;
  throw FileError("create the folder", folder, reason == EEXIST ? ENOTDIR : reason);
}

/// Makes a renaming last. Best effort: without it an older name may be back after the power failed.
void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

constexpr const char* staging_prefix = ".hompm-partial-";

/// Removes the staging folders of runs that were killed: all, for nobody else is at work here.
void remove_left_over(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end; entry.increment(ignored))
    if (entry->path().filename().string().starts_with(staging_prefix)) found.push_back(entry->path());
  for (const auto& path : found) fs::remove_all(path, ignored);
}

/// A new one. A number is appended where a process of the same id, in another container, has one.
fs::path create_staging(const fs::path& folder) {
  const fs::path base = folder / (staging_prefix + std::to_string(::getpid()));
  fs::path path = base;
  for (int copy = 1; !create_folder(path); ++copy) {
    // LCOV_EXCL_START: where the file system has no locks, and nothing left over is removed
    path = base;
    path += '-';  // "-" + std::to_string(copy) makes g++ 12 -O3 warn of an overlap (GCC bug 105651)
    path += std::to_string(copy);
    // LCOV_EXCL_STOP
  }
  return path;
}

}  // namespace

CreatedFolders::CreatedFolders(const fs::path& folder) {
  if (folder.empty()) throw FileError("the name of the output folder is empty");
  fs::path current;
  try {
    for (const auto& part : folder) {
      current /= part;
      if (!part.empty() && create_folder(current)) created_.push_back(current);
    }
  } catch (...) {
    remove_empty();
    throw;
  }
}

CreatedFolders::~CreatedFolders() { remove_empty(); }

void CreatedFolders::remove_empty() {
  while (!created_.empty()) {
    ::rmdir(created_.back().c_str());  // refuses a folder that holds something, which is what is wanted
    created_.pop_back();
  }
}

StagingFolder::StagingFolder(fs::path folder, bool waits)
    : folder_(std::move(folder)), created_(folder_), lock_(folder_, waits) {
  if (lock_.exclusive()) remove_left_over(folder_);
  staging_ = create_staging(folder_);
}

StagingFolder::~StagingFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
}

fs::path StagingFolder::add(const std::string& name) {
  fs::path path = staging_ / name;
  create_folder(path.parent_path());
  names_.insert(name);
  return path;
}

TextFile StagingFolder::create(const std::string& name) { return TextFile(add(name), folder_ / name); }

void StagingFolder::move_into_place(const std::string& name) {
  const fs::path target = folder_ / name;
  create_folder(target.parent_path());
  if (std::rename((staging_ / name).c_str(), target.c_str()) != 0) throw FileError("write", target, errno);
  names_.erase(name);
}

void StagingFolder::replace(const std::string& name, std::string_view content) {
  try {
    auto file = create(name);
    file << content;
    file.close_on_disk();
    move_into_place(name);
    sync_folder(folder_);
  } catch (const FileError&) {
    std::error_code ignored;
    fs::remove(staging_ / name, ignored);  // gives the disk its space back
    names_.erase(name);
    throw;
  }
}

void write_whole(const fs::path& path, std::string_view text) {
  std::error_code none;
  if (fs::exists(path, none) && !fs::is_regular_file(path, none)) {
    TextFile file(path, path);
    file << text;
    return file.close();
  }
  constexpr bool waits = true;
  StagingFolder(path.has_parent_path() ? path.parent_path() : ".", waits).replace(path.filename(), text);
}

}  // namespace hompm::detail
