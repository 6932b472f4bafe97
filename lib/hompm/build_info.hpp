// How this library was built, for run.json and provenance.
#pragma once

#include <string>

namespace hompm {

struct BuildInfo {
  std::string version;   ///< of hompm
  std::string commit;    ///< of the source tree, with "-dirty" after it when the tree was changed; "unknown"
                         ///< outside git
  std::string compiler;  ///< "GNU 12.2.0"
  std::string flags;     ///< that can change code: optimisation and floating point
  std::string build_type;
  std::string architecture;
  std::string boost;  ///< version
};

const BuildInfo& build_info();

}  // namespace hompm
