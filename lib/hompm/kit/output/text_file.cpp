#include <cerrno>
#include <fcntl.h>
#include <unistd.h>
#include <utility>

#include <hompm/error.hpp>
#include <hompm/kit/output/text_file.hpp>
#include <hompm/number.hpp>

namespace hompm::detail {
namespace {

/// Bytes per write: large enough for the disk, small in memory.
constexpr std::size_t chunk = 1 << 18;

}  // namespace

TextFile::TextFile(const std::filesystem::path& path, std::filesystem::path shown)
    : shown_(std::move(shown)),
      descriptor_(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) throw FileError("write", shown_, errno);
}

TextFile::~TextFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

TextFile& TextFile::operator<<(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= chunk) flush();
  return *this;
}

TextFile& TextFile::operator<<(double value) {
  append_text(buffer_, value);
  return *this;
}

TextFile& TextFile::operator<<(std::size_t value) { return *this << std::to_string(value); }

void TextFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const auto written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw FileError("write", shown_, errno);
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void TextFile::close() {
  if (descriptor_ < 0) return;
  flush();
  // Network file systems report a full disk only here. A descriptor is gone even when closing fails.
  if (::close(std::exchange(descriptor_, -1)) != 0) throw FileError("write", shown_, errno);
}

void TextFile::close_on_disk() {
  flush();
  // EINVAL: a file system that cannot promise it
  if (::fsync(descriptor_) != 0 && errno != EINVAL) throw FileError("write", shown_, errno);
  close();
}

}  // namespace hompm::detail
