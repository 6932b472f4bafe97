// Files of other codes as tables.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

namespace hompm::cli {

/// A file that can be read as a table: the one that was named, or a temporary one with what it holds.
class TableFile {
 public:
  /// `name` is a file, a pipe or "-" for standard input; a table, VTK XML (.vtu, .vtp, .pvd: ASCII, base64,
  /// raw, compressed by zlib), a LAMMPS dump, or one of these compressed by gzip. Of vectors and tensors the
  /// component in `direction` is taken; `step` (s, 0 for none) is the time step of a dump that counts steps.
  /// Throws `FileError` for what cannot be read, with the converter where one is known.
  TableFile(const std::string& name, char direction, double step);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }  // NOLINT(cppcoreguidelines-owning-memory)
  };
  using File = std::unique_ptr<std::FILE, Close>;
  void spool(const std::string& text);

  std::string name_;
  File file_;  // where it is a temporary one: it has no name
  std::filesystem::path path_;
};

}  // namespace hompm::cli
