// Any command line gives a result or is refused in words one can read, never as an internal error. The first
// line of the input names the tool (run, diff, study, exact), each further line is an argument. The tools run
// in this process, in an empty folder with a few good files; hompm-run only explains, hompm-study only lists,
// hompm-exact computes a short time.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

#include "demand.hpp"

// The main functions of the tools; CMakeLists.txt names them so.
int hompm_run_main(int argc, char** argv);
int hompm_diff_main(int argc, char** argv);
int hompm_study_main(int argc, char** argv);
int hompm_exact_main(int argc, char** argv);

namespace {

namespace fs = std::filesystem;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line.substr(0, line.find('\0')));
  return lines;
}

/// Files may be written and read below the folder alone, and no other program is started.
bool is_harmless(const std::string& word) {
  return word.find('/') == std::string::npos && word.find("..") == std::string::npos &&
         word.find("picture") == std::string::npos;
}

/// What a tool prints.
class Caught {
 public:
  Caught() : out_(std::cout.rdbuf(text_.rdbuf())), error_(std::cerr.rdbuf(errors_.rdbuf())) {}
  ~Caught() {
    std::cout.rdbuf(out_);
    std::cerr.rdbuf(error_);
  }
  Caught(const Caught&) = delete;
  Caught& operator=(const Caught&) = delete;
  [[nodiscard]] std::string errors() const { return errors_.str(); }

 private:
  std::ostringstream text_, errors_;
  std::streambuf* out_;
  std::streambuf* error_;
};

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* const folder = std::getenv("HOMPM_FILES");  // good files, for what reads some
  const fs::path own = fs::temp_directory_path() / ("hompm-fuzz-" + std::to_string(::getpid()));
  fs::create_directories(own);
  if (folder != nullptr) fs::copy(folder, own, fs::copy_options::recursive);
  fs::current_path(own);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::string> words = lines_of(std::string(reinterpret_cast<const char*>(data), size));
  if (words.empty() || !std::all_of(words.begin(), words.end(), is_harmless)) return 0;
  const std::string tool = words.front();
  if (tool != "run" && tool != "diff" && tool != "study" && tool != "exact") return 0;
  if (tool == "run") words.emplace_back("--explain");
  if (tool == "study") words.emplace_back("--list");
  if (tool == "exact") words.emplace_back("--end-time=0.01");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  const int argc = static_cast<int>(argv.size());
  argv.push_back(nullptr);
  int code = 0;
  std::string errors;
  {
    const Caught caught;
    code = tool == "run"     ? hompm_run_main(argc, argv.data())
           : tool == "diff"  ? hompm_diff_main(argc, argv.data())
           : tool == "exact" ? hompm_exact_main(argc, argv.data())
                             : hompm_study_main(argc, argv.data());
    errors = caught.errors();
  }
  demand(code >= 0 && code != 1 && code <= 6, "exit code " + std::to_string(code) + ": " + errors);
  demand(errors.find("internal error") == std::string::npos, errors);
  demand(code == 0 || code == 3 || !errors.empty(), "a refusal has a reason");
  demand(errors.size() < 20000, errors);
  return 0;
}
