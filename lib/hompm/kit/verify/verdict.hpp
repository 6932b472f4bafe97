// What the errors of a run mean: whether to use it, why not, and what helps.
#pragma once

#include <optional>
#include <string>

#include <hompm/kit/verify/judge.hpp>

namespace hompm {

enum class VerdictLevel {
  good,      ///< the bound of every field is 5 % at most
  doubtful,  ///< between
  bad,       ///< the bound of a field is above 20 %, and at least half of it is the error of the run
  unknown,   ///< there are no errors, or the reference is not good enough to tell
};

/// What the errors come from, as far as it can be told.
struct Cause {
  std::string code;  ///< "grid-crossing", "time-step", "jump", "resolution", "kink", "quadrature", "energy";
                     ///< "" for none
  std::string text;  ///< what was found
  std::string cure;  ///< in options of hompm-run
};

struct RunVerdict {
  VerdictLevel level = VerdictLevel::unknown;
  std::string text;  ///< one line, the level first
  Cause cause;       ///< empty where the level is good or unknown
};

/// `reason` says why there are no errors.
RunVerdict verdict_of(const Scene& scene, const RunResult& result, const std::optional<ErrorReport>& errors,
                      const std::string& reason, const RunMotion& motion);

/// What the scene requires and the run does not meet, a line for each field: the number reached and what to
/// do; "" where all is met.
std::string unmet(const Scene& scene, const std::optional<ErrorReport>& errors, const RunVerdict& verdict);

const char* to_string(VerdictLevel level);
const char* to_string(ErrorKind kind);

}  // namespace hompm
