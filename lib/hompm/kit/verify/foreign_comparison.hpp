// Results of another code against those of a golden folder and against the exact solution.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hompm/kit/verify/compare.hpp>
#include <hompm/kit/verify/judge.hpp>

namespace hompm {

/// An option that does not fit the folder it is about: a time it does not have, say.
class OptionError : public Error {
 public:
  using Error::Error;
};

struct ForeignOptions {
  /// By field, for A against B; `relative` is here relative to `ForeignField::scale`, because fields of a
  /// body that swings vanish at some times.
  std::map<std::string, Tolerance> tolerances = {};
  /// By field: largest error against the exact solution over the scale, at every time.
  std::map<std::string, double> exact = {};
  std::vector<std::string> required = {};           ///< fields A must have
  std::vector<std::string> fields = {};             ///< the only ones compared; all when empty
  std::vector<double> times = {};                   ///< s; only these of B, all when empty
  bool interpolate = false;                         ///< times of B that A lacks, from those of A around them
  double time_tolerance = 0.0;                      ///< s, by which times may differ and be the same
  std::map<std::string, std::string> columns = {};  ///< by field the name or number of its column in A
  char direction = 'x';                             ///< of A, where it is of a 2D or 3D code
  std::string name = {};                            ///< of A in messages; its path when empty
};

/// One field at one time. Errors are in the unit of the field; against the exact solution, over all particles
/// of A (of B).
struct ForeignField {
  std::string field;
  double time = 0.0;                            ///< s
  double scale = 0.0;                           ///< largest magnitude of the field in B, at any of its times
  std::uint64_t particles = 0;                  ///< of A and B, matched by X
  std::uint64_t differing = 0;                  ///< of these: not bit-equal
  std::uint64_t beyond = 0;                     ///< not bit-equal and beyond the tolerance
  bool beyond_exact = false;                    ///< further from the exact solution than asked for
  double worst_X = 0.0;                         ///< m, where |A − B| is largest
  ErrorNorms difference = {};                   ///< A − B; means nothing without `particles`
  std::optional<ErrorNorms> error = {};         ///< A − exact
  std::optional<ErrorNorms> golden_error = {};  ///< B − exact
};

/// Values of one field at one time over X, ascending in each body.
struct ForeignCurves {
  std::string field;
  double time = 0.0;                          ///< s
  std::vector<double> X_a, a, X_b, b;         ///< A and B
  std::vector<double> exact_a, exact_b;       ///< exact at X_a and X_b; empty where none is known
  std::vector<double> X_matched, difference;  ///< A − B where both have a particle
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< these particles, by their numbers in A and B
};

struct ForeignComparison {
  Verdict verdict = Verdict::identical;
  std::vector<std::string> messages;  ///< what makes the verdict `different`; one line each, with the file
  std::vector<std::string> hints;     ///< which mistake would explain that
  std::vector<std::string> notes;     ///< what does not
  std::vector<std::string> not_compared;  ///< fields of B that A does not have
  std::string reference;                  ///< which exact or reference solution; "" for none
  double reference_error = 0.0;       ///< its own, the largest of all times; relative L2 of the displacement
  std::vector<ForeignField> fields;   ///< in the order of fields and times
  std::vector<ForeignCurves> curves;  ///< as `fields`
};

/// The fields that are compared where A has them: x, displacement, velocity, volume, density, stress,
/// stretch.
const std::vector<std::string>& foreign_fields();
/// Those that exact solutions are known for: displacement, velocity, stress.
const std::vector<std::string>& exact_fields();

/// Compares the table `a` of another code with `b`: a golden folder, or one of hompm-run, with scene.toml,
/// particles.csv and stress.csv; or a scene file, or the name of a built-in case such as bar-small, of which
/// the exact solution is compared with. `a` needs the columns X, time and one field, in any order; others are
/// let pass, unless they look like a field that is not there. Particles are matched by body and X, to a
/// thousandth of their distance (of the cell, where there is one), times to 1e-9 of the last. For a scene
/// that ends at rest the last times are held against each other, whatever they are. Where A ends a little (1
/// %) before the last time, the others are compared, with a note.
///
/// Verdict: without any bound one bit makes it `different`; with bounds only fields with a bound are judged,
/// and each field of B that has one must be in A, or follow from what is. With bounds on the exact solution
/// alone particles need no partners. `messages` make it `different` in any case. Throws `FileError` when a
/// file cannot be read or nothing in it compared, `SceneError` for a bad scene in `b`, `OptionError` for
/// times B does not have and bounds on an exact solution that is not known.
ForeignComparison compare_foreign(const std::filesystem::path& a, const std::filesystem::path& b,
                                  const ForeignOptions& options);

}  // namespace hompm
