#include <cerrno>
#include <cstdio>
#include <sys/stat.h>
#include <unistd.h>

#include <hompm/error.hpp>
#include <hompm/output/staging.hpp>

namespace hompm::detail {
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

/// The staging folder of this process. A number is appended when another run of the same process id (in
/// another container, or killed long ago) has one here.
fs::path create_staging(const fs::path& folder) {
  const fs::path base = folder / (".hompm-partial-" + std::to_string(::getpid()));
  fs::path staging = base;
  for (int copy = 1; !create_folder(staging); ++copy) {
    staging = base;
    staging += "-" + std::to_string(copy);
  }
  return staging;
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

StagingFolder::StagingFolder(fs::path folder)
    : folder_(std::move(folder)), created_(folder_), staging_(create_staging(folder_)) {}

StagingFolder::~StagingFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
}

TextFile StagingFolder::create(const std::string& name) {
  const fs::path path = staging_ / name;
  create_folder(path.parent_path());
  names_.insert(name);
  return TextFile(path, folder_ / name);
}

void StagingFolder::move_into_place(const std::string& name) {
  const fs::path target = folder_ / name;
  create_folder(target.parent_path());
  if (std::rename((staging_ / name).c_str(), target.c_str()) != 0) throw FileError("write", target, errno);
  names_.erase(name);
}

}  // namespace hompm::detail
