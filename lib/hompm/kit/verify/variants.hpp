// Which variant of a scheme the results of another code come from: the scene is run with one choice of its
// scheme changed, then another, and each run is held against the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <hompm/kit/verify/foreign_comparison.hpp>

namespace hompm {

/// The scene with some keys of its scheme changed, and how far the file agrees with its run.
struct SchemeVariant {
  std::vector<std::pair<std::string, std::string>> changes = {};  ///< key and value; none: the scene as it is
  std::string refused = {};  ///< why it could not be run to its end; "" where it was
  /// By field: the largest difference over the largest value of the run, at all times.
  std::map<std::string, double> differences = {};
  double largest = std::numeric_limits<double>::infinity();  ///< of these; infinite where one is not known
  /// Where the file leaves the run: the first step at which a field differs by more than 1e-9 of its largest
  /// value, or, of the scene as it is, ten times what the best variant differs by (1e-12 at least); step −1
  /// where there is none.
  std::int64_t step = -1;
  double time = 0.0;  ///< s
  double X = 0.0;     ///< m, of the particle that differs most there
  std::string field = {};
};

struct SchemeVariants {
  std::vector<SchemeVariant> tried = {};  ///< the scene as it is, then the others, best first
  std::size_t refused = 0;                ///< variants that the scene does not admit, or that became invalid
  std::vector<double> times = {};         ///< s, at which all were held against the file
  std::vector<std::string> notes = {};
};

/// Runs the scene of `b` (golden folder, scene file or built-in case) as it is, and with each choice of its
/// scheme, its degree, its time step and its law changed by itself; from the best of these again while a
/// further change gives a fifth of a digit more, three changes at most. A is held against each run at the
/// times of `a` that lie on steps (twenty at most, of the first and last). `options` says how to read A.
/// `progress` is told how many of how many runs are done. Throws `FileError`, where no particle is that of A,
/// too; `SceneError`; `OptionError` where no time of A lies on a step of the scene or it runs to rest.
SchemeVariants scheme_variants(const std::filesystem::path& a, const std::filesystem::path& b,
                               const ForeignOptions& options,
                               const std::function<void(std::int64_t, std::int64_t)>& progress = {});

}  // namespace hompm
