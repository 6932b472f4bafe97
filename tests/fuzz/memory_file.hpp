// A file in memory, for readers that want a path.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <sys/mman.h>
#include <unistd.h>

#include "demand.hpp"

class MemoryFile {
 public:
  MemoryFile(const void* data, std::size_t size) : descriptor_(::memfd_create("fuzzed", MFD_CLOEXEC)) {
    demand(::write(descriptor_, data, size) == static_cast<ssize_t>(size), "the memory file is written");
  }
  explicit MemoryFile(std::string_view text) : MemoryFile(text.data(), text.size()) {}
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};
