// The points of a study with all that is known about them, and which settings are worth their cost.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <hompm/kit/study/record.hpp>

namespace hompm::study {

/// A run as far as a choice is concerned. Both are finite and ≥ 0.
struct Candidate {
  double cost = 0.0;
  double error = 0.0;
};

/// Indices of the candidates that no other beats in cost and error alike, by rising cost and falling error.
/// Of equal ones the first.
std::vector<std::size_t> pareto_front(std::span<const Candidate> candidates);

/// Index of the cheapest candidate with at most this error, of equal ones the most accurate; nothing where
/// none is as accurate.
std::optional<std::size_t> cheapest(std::span<const Candidate> candidates, double error);

enum class Field { displacement, velocity, stress };
inline constexpr std::array all_fields{Field::displacement, Field::velocity, Field::stress};
std::string to_string(Field field);

enum class Cost { instructions, seconds, particle_steps };
/// "instructions", "seconds", "particle steps".
std::string to_string(Cost cost);

struct Outcome {
  Point point;
  Record record;
  std::vector<double> seconds;  ///< none where it was not timed
};

/// Norms of a field, with the reference's own error; nothing for a point that failed.
struct FieldError {
  ErrorNorms norms;
  double reference = 0.0;  ///< relative L2
};
std::optional<FieldError> error_of(const Outcome& outcome, Field field);

/// What a point cost; nothing where that was not measured.
std::optional<double> cost_of(const Outcome& outcome, Cost cost);

/// The outcomes with a relative L2 error of the field and a cost.
struct Choice {
  std::vector<const Outcome*> outcomes;
  std::vector<Candidate> candidates;  ///< of each
};
Choice choice_of(const std::vector<Outcome>& outcomes, Field field, Cost cost);
/// Those of one scheme alone.
Choice of_scheme(const Choice& choice, const std::string& scheme);
/// Names of the schemes, in the order in which the outcomes name them first.
std::vector<std::string> schemes_in(const std::vector<Outcome>& outcomes);

/// The outcome of every point that has a record in `folder` by this program, and the names of the others.
struct Gathered {
  std::vector<Outcome> outcomes;
  std::vector<std::string> missing;
};
Gathered gather(const Study& study, const std::vector<Point>& points, const std::filesystem::path& folder,
                const std::string& program);

/// Whether a record is of this point as it would be run now by this program.
bool is_current(const Study& study, const Point& point, const Record& record, const std::string& program);

}  // namespace hompm::study
