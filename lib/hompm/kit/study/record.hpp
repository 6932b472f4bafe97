// What is known about one point of a study once it has been run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <hompm/kit/study/study.hpp>
#include <hompm/kit/verify/judge.hpp>

namespace hompm::study {

enum class Status {
  ok,
  refused,   ///< before it ran: settings that do not go together, a step that is too large
  invalid,   ///< the run stopped being valid
  unjudged,  ///< it ran, and there is nothing to judge it by
};

/// "ok", "refused", …
std::string to_string(Status status);

/// Work as the code counts it, over the whole run as planned.
struct Work {
  std::int64_t particles = 0;          ///< of the body
  std::int64_t steps = 0;              ///< time steps
  std::int64_t force_evaluations = 0;  ///< 1 a step, 6 with blanes-moan
  std::int64_t mass_solves = 0;        ///< systems with the consistent mass
  std::int64_t bytes = 0;              ///< arrays of particles and grid, once per force evaluation
  [[nodiscard]] std::int64_t particle_steps() const { return particles * steps; }
};

/// Of `Simulation::step`, counted in steps that start from states of the run at evenly spaced moments.
struct Instructions {
  std::uint64_t counted = 0;       ///< in all counted steps
  std::int64_t counted_steps = 0;  ///
  std::uint64_t total = 0;         ///< counted · steps/counted_steps
  double per_particle_and_step = 0.0;
};

struct Record {
  std::string name;     ///< of the point
  std::string program;  ///< which program measured it, `program_id`
  std::string scene;    ///< resolved, as TOML; "" where the settings do not go together
  Status status = Status::ok;
  std::string reason;  ///< where it is not ok
  std::string scheme;
  int degree = 0;
  int cells = 0;
  int particles_per_cell = 0;
  double time_step = 0.0;  ///< s
  Work work;
  std::optional<ErrorReport> errors;
  std::optional<Instructions> instructions;
};

/// Instructions of a run of `work.steps` steps, from those of a few.
Instructions extrapolated(std::uint64_t counted, std::int64_t counted_steps, const Work& work);

/// The record as JSON, and back. `read_record` throws `Error` for a text that is none.
std::string record_text(const Record& record);
Record read_record(const std::string& text);

/// Wall-clock times of one point, s, in the order in which they were taken.
struct Times {
  std::string name;
  std::string program;
  std::string scene;
  std::vector<double> seconds;
};
std::string times_text(const Times& times);
Times read_times(const std::string& text);

/// DIR/points/NAME.json and DIR/times/NAME.json.
std::filesystem::path record_path(const std::filesystem::path& folder, const std::string& name);
std::filesystem::path times_path(const std::filesystem::path& folder, const std::string& name);

/// The text of a file, or nothing where there is no such file.
std::optional<std::string> text_of(const std::filesystem::path& path);

}  // namespace hompm::study
