// Two equal runs, one of them to be damaged and compared with the other.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <hompm/kit/verify/compare.hpp>

#include "support/sample_run.hpp"
#include "support/temporary_folder.hpp"

namespace hompm::test {

namespace fs = std::filesystem;
using Lines = std::vector<std::string>;

inline std::string joined(const Lines& lines, const std::string& separator) {
  std::string text;
  for (const auto& line : lines) text += line + separator;
  return text;
}

inline Lines split(const std::string& text, char separator) {
  Lines parts;
  std::size_t begin = 0;
  for (auto end = text.find(separator); end != text.npos; end = text.find(separator, begin)) {
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  if (begin < text.size()) parts.push_back(text.substr(begin));
  return parts;
}

/// Two equal runs of five particles at three times: `b` is left alone, `a` is for damaging.
struct Pair {
  static constexpr std::size_t particles = 5;
  TemporaryFolder folder;
  fs::path a = folder / "a";
  fs::path b = folder / "b";

  Pair() {
    write_sample_run(a, particles);
    write_sample_run(b, particles);
  }
  void change_text(const std::string& file, const std::function<void(std::string&)>& change) const {
    auto text = read_file(a / file);
    change(text);
    write_file(a / file, text);
  }
  void change_lines(const std::string& file, const std::function<void(Lines&)>& change) const {
    change_text(file, [&](std::string& text) {
      auto lines = split(text, '\n');
      change(lines);
      text = joined(lines, "\n");
    });
  }
  /// Puts `value` in place of one field; lines count from 0, the header.
  void set(const std::string& file, std::size_t line, std::size_t column, const std::string& value) const {
    change_lines(file, [&](Lines& lines) {
      auto fields = split(lines[line], ',');
      fields[column] = value;
      lines[line] = joined(fields, ",");
      lines[line].pop_back();
    });
  }
  [[nodiscard]] std::string get(const std::string& file, std::size_t line, std::size_t column) const {
    return split(split(read_file(b / file), '\n')[line], ',')[column];
  }
  [[nodiscard]] Comparison compare(const std::map<std::string, hompm::Tolerance>& tolerances = {}) const {
    return compare_folders(a, b, tolerances);
  }
};

}  // namespace hompm::test
