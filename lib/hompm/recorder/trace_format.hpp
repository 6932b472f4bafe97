// What the writer and the reader of traces agree on.
#pragma once

#include <cstdint>
#include <string_view>

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

}  // namespace hompm::detail
