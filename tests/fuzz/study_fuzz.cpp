// Any bytes are a study file, a record of a point, times of one, or are refused in lines one can read; a
// study that is written is read as the same study. Nothing is run.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/kit/study/record.hpp>
#include <hompm/kit/study/study.hpp>

#include "demand.hpp"
#include "memory_file.hpp"

namespace {

using namespace hompm;

void attempt(const std::function<void()>& action) {
  try {
    action();
  } catch (const SceneError& error) {
    demand(!error.problems().empty(), "an error tells a problem");
    for (const Problem& problem : error.problems()) demand(is_line(problem.message), problem.message);
  } catch (const Error& error) {
    demand(is_line(error.what()), error.what());
  }
}

/// The order of settings means nothing.
std::string sorted_lines(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  std::sort(lines.begin(), lines.end());
  std::string sorted;
  for (const std::string& line : lines) sorted += line + "\n";
  return sorted;
}

void read_study(const std::string& text) {
  const study::Study found = study::read_study(MemoryFile(text).path().string());
  const std::string written = study::study_text(found);
  if (found.scene_file.empty()) {
    const std::string again = study::study_text(study::read_study(MemoryFile(written).path().string()));
    demand(sorted_lines(again) == sorted_lines(written),
           "a written study is the same study:\n" + written + again);
  }
  if (study::points_of(found).size() < 50) study::checked_points(found);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  attempt([&] { read_study(text); });
  attempt([&] { study::record_text(study::read_record(text)); });
  attempt([&] { study::times_text(study::read_times(text)); });
  attempt([&] { study::read_axes(text); });
  return 0;
}
