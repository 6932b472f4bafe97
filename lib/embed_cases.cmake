# Writes a C++ file with the text of each scene in CASES: hompm::detail::embedded_cases().
set(body "")
foreach(case ${CASES})
  get_filename_component(name ${case} NAME_WE)
  file(READ ${case} text)
  string(APPEND body "      {\"${name}\", R\"scene(${text})scene\"},\n")
endforeach()
file(WRITE ${OUTPUT}
"#include <hompm/kit/scene_file/embedded_cases.hpp>

namespace hompm::detail {

const std::vector<EmbeddedCase>& embedded_cases() {
  static const std::vector<EmbeddedCase> cases{
${body}  };
  return cases;
}

}  // namespace hompm::detail
")
