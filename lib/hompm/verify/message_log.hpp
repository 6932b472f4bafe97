// Messages for the reader, so that a file with a million faults still gives a short report.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace hompm::detail {

class MessageLog {
 public:
  /// Keeps "<file> line <line>: <text>" for the first few of a kind in one file and counts the rest. `kind`
  /// is a plural: "missing rows". Line 0 stands for the file as a whole.
  void add(const std::string& file, const std::string& kind, std::int64_t line, const std::string& text) {
    if (counts_[{file, kind}]++ >= shown_of_a_kind) return;
    messages_.push_back(file + (line > 0 ? " line " + std::to_string(line) : "") + ": " + text);
  }

  /// All messages in the order in which they came, then what was only counted.
  [[nodiscard]] std::vector<std::string> messages() const {
    auto all = messages_;
    for (const auto& [what, count] : counts_) {
      if (count <= shown_of_a_kind) continue;
      all.push_back(what.first + ": " + what.second + ": " + std::to_string(count - shown_of_a_kind) +
                    " more");
    }
    return all;
  }

 private:
  static constexpr std::int64_t shown_of_a_kind = 3;
  std::vector<std::string> messages_;
  std::map<std::pair<std::string, std::string>, std::int64_t> counts_;
};

}  // namespace hompm::detail
