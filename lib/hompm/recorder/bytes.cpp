#include <algorithm>
#include <array>
#include <cerrno>
#include <fcntl.h>
#include <unistd.h>

#include <hompm/recorder/bytes.hpp>

namespace hompm::detail {

void add_bytes(Hash& hash, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto part = bytes.substr(0, 8);
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < part.size(); ++i)
      word |= std::uint64_t{static_cast<unsigned char>(part[i])} << (8 * i);
    hash.add(word);
    bytes.remove_prefix(part.size());
  }
}

std::uint64_t hash_of_bytes(std::string_view bytes) {
  Hash hash;
  add_bytes(hash, bytes);
  hash.add(bytes.size());
  return hash.value();
}

std::string read_bytes(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw FileError("read", path, errno);
  std::string bytes;
  std::array<char, 1 << 16> chunk{};
  for (;;) {
    const auto size = ::read(descriptor, chunk.data(), chunk.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) {
      const int reason = errno;
      ::close(descriptor);
      if (size < 0) throw FileError("read", path, reason);
      return bytes;
    }
    bytes.append(chunk.data(), static_cast<std::size_t>(size));
  }
}

}  // namespace hompm::detail
