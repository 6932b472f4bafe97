#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <hompm/error.hpp>
#include <hompm/output/folder_lock.hpp>

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

}  // namespace hompm::detail
