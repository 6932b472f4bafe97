// The scene files of lib/cases/, compiled in (the source is written by lib/embed_cases.cmake).
#pragma once

#include <string>
#include <vector>

namespace hompm::detail {

struct EmbeddedCase {
  std::string name;  ///< file name without ending, "column-large"
  std::string text;  ///< TOML
};

const std::vector<EmbeddedCase>& embedded_cases();

}  // namespace hompm::detail
