#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

#include <hompm/error.hpp>
#include <hompm/verify/line_reader.hpp>

namespace hompm::detail {
namespace {

constexpr std::size_t buffer_size = 1 << 18;
constexpr std::size_t longest_line = 1 << 16;

}  // namespace

LineReader::LineReader(std::filesystem::path path)
    // O_NONBLOCK: opening a pipe must not wait for a writer. It means nothing for regular files.
    : path_(std::move(path)),
      descriptor_(::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)),
      buffer_(std::make_unique_for_overwrite<char[]>(buffer_size)) {
  if (descriptor_ < 0) throw FileError("read", path_, errno);
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    throw FileError("cannot read " + path_.string() + ": not a regular file");
  }
}

LineReader::~LineReader() { ::close(descriptor_); }

bool LineReader::next() {
  std::size_t searched = 0;
  while (true) {
    const char* start = buffer_.get() + begin_;
    const void* found = std::memchr(start + searched, '\n', end_ - begin_ - searched);
    if (found != nullptr) {
      has_end_ = true;
      take(static_cast<std::size_t>(static_cast<const char*>(found) - start));
      ++begin_;
      return true;
    }
    searched = end_ - begin_;
    if (searched > longest_line) {
      throw FileError("cannot read " + path_.string() + ": line " + std::to_string(number_ + 1) +
                      " is longer than " + std::to_string(longest_line) + " characters");
    }
    if (fill()) continue;
    if (searched == 0) return false;
    has_end_ = false;
    take(searched);
    return true;
  }
}

void LineReader::rewind() {
  if (::lseek(descriptor_, 0, SEEK_SET) < 0) throw FileError("read", path_, errno);
  begin_ = end_ = 0;
  number_ = 0;
}

void LineReader::take(std::size_t length) {
  line_ = {buffer_.get() + begin_, length};
  begin_ += length;
  ++number_;
  has_carriage_return_ = line_.ends_with('\r');
  if (has_carriage_return_) line_.remove_suffix(1);
}

bool LineReader::fill() {
  std::memmove(buffer_.get(), buffer_.get() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  while (true) {
    const auto count = ::read(descriptor_, buffer_.get() + end_, buffer_size - end_);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw FileError("read", path_, errno);
    end_ += static_cast<std::size_t>(count);
    return count > 0;
  }
}

}  // namespace hompm::detail
