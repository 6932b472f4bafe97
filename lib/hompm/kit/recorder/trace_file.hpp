// Reads a trace, entry by entry; what its writer and its reader agree on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <hompm/kit/recorder/bytes.hpp>
#include <hompm/plan/fields.hpp>

namespace hompm::detail {

inline constexpr std::string_view trace_magic = "hompm trace\n\n\n\n\n";
inline constexpr std::uint64_t trace_format = 2;

/// Two bytes that say what comes next. Any lower number is a stage: the hash of a field after it follows.
enum TraceTag : std::uint16_t {
  next_step = 0xffff,
  next_part = 0xfffe,     ///< the next kick and drift of the step
  entry_values = 0xfffd,  ///< the values behind the hash before
  all_values = 0xfffc,    ///< those of all fields
  trace_end = 0xfffb,     ///< a hash of all bytes before this tag follows
  first_tag = 0xff00,
};

struct TraceStage {
  std::string name;
  std::string called_by;
};

struct TraceField {
  std::string name;
  std::size_t body;
  Site site;
  bool is_integer;
  std::size_t size;         ///< entries
  std::uint64_t hash;       ///< of the last entry that was taken
  std::string_view values;  ///< then, 8 bytes each; empty when they are not in the trace
};

/// A field after a stage that changed it.
struct TraceEntry {
  std::int64_t step;
  int part;  ///< of the step, from 1
  std::size_t stage;
  std::size_t field;
  bool operator==(const TraceEntry&) const = default;
  bool operator<(const TraceEntry& other) const {
    return std::tie(step, part, stage, field) < std::tie(other.step, other.part, other.stage, other.field);
  }
};

class TraceFile {
 public:
  /// Reads the whole file; messages call it `name`. Throws `FileError` when it cannot be read or is damaged.
  TraceFile(const std::filesystem::path& path, std::string name);

  std::string name;
  std::string build;
  std::string scene;  ///< TOML
  std::size_t markers = 0;
  std::int64_t first_step = 0;  ///< after which it begins
  std::vector<TraceStage> stages;
  std::vector<TraceField> fields;

  /// The entry that `take` will take; none at the end.
  [[nodiscard]] const std::optional<TraceEntry>& next() const { return next_; }
  /// Brings its field up to date.
  void take();
  /// The last step that has begun, up to `next`.
  [[nodiscard]] std::int64_t step() const { return step_; }
  /// It has an end, so the run was not cut off.
  [[nodiscard]] bool complete() const { return complete_; }

 private:
  void read_header();
  void check_fields() const;
  std::string word();
  void read_next();
  void read_entry(std::uint64_t stage);
  [[noreturn]] void damaged() const;

  std::string bytes_;
  ByteReader in_{""};
  std::optional<TraceEntry> next_;
  std::uint64_t next_hash_ = 0;
  std::string_view next_values_;
  std::int64_t step_ = 0;
  int part_ = 1;
  bool complete_ = false;
};

}  // namespace hompm::detail
