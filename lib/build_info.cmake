# Writes build_info.cpp, only when it changes: the commit is read at every build.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=12 --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit "unknown")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT
"#include <hompm/build_info.hpp>

namespace hompm {

const BuildInfo& build_info() {
  static const BuildInfo info{.version = \"@VERSION@\",
                              .commit = \"@commit@\",
                              .compiler = \"@COMPILER@\",
                              .flags = \"@FLAGS@\",
                              .build_type = \"@BUILD_TYPE@\",
                              .architecture = \"@ARCHITECTURE@\",
                              .boost = \"@BOOST@\"};
  return info;
}

}  // namespace hompm
")
