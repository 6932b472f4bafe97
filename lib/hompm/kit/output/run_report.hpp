// What a run is summed up to: run.json, and the summary a person reads.
#pragma once

#include <optional>
#include <string>

#include <hompm/kit/verify/verdict.hpp>

namespace hompm {

struct RunReport {
  const Scene& scene;
  const TimeStepping& stepping;
  const RunResult& result;
  const std::optional<ErrorReport>& errors;
  const std::string& no_errors_because;
  RunVerdict verdict = {};
};

/// run.json as text, one key a line.
std::string run_json(const RunReport& report);

/// timing.json as text: what the run and, where it was computed, its reference solution took on the wall
/// clock (s), the one output that differs from run to run.
std::string timing_json(const RunResult& result, double seconds,
                        std::optional<double> reference_seconds = {});

/// A dozen lines for a terminal.
std::string run_summary(const RunReport& report);

}  // namespace hompm
