// Other programs that a tool runs.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace hompm::cli {

/// Runs a command, its output and complaints in the file `log`; its exit code, 128 + the signal that ended
/// it, or 127 where there is no such program. `check` is called while waiting; what it throws ends the child.
int run_child(std::vector<std::string> command, const std::string& log, const std::function<void()>& check);

}  // namespace hompm::cli
