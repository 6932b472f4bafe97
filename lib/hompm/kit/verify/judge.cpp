#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include <hompm/kit/verify/judge.hpp>
#include <hompm/number.hpp>

namespace hompm {

ErrorNorms error_norms(std::span<const double> numerical, std::span<const double> exact) {
  if (numerical.size() != exact.size())
    throw Error("error norms of " + std::to_string(numerical.size()) + " values against " +
                std::to_string(exact.size()));
  if (numerical.empty()) return {};
  ErrorNorms norms;
  double largest_exact = 0.0;
  for (std::size_t p = 0; p < numerical.size(); ++p) {
    norms.max = std::max(norms.max, std::abs(numerical[p] - exact[p]));
    largest_exact = std::max(largest_exact, std::abs(exact[p]));
  }
  // Squares of what is tiny vanish, and those of what is huge are infinite.
  const auto scale_of = [](double largest) {
    return largest < 0x1p-400 ? 0x1p600 : largest > 0x1p400 ? 0x1p-600 : 1.0;
  };
  const double scale_error = scale_of(norms.max);
  const double scale_exact = scale_of(largest_exact);
  double squared_error = 0.0;
  double squared_exact = 0.0;
  for (std::size_t p = 0; p < numerical.size(); ++p) {
    const double error = scale_error * (numerical[p] - exact[p]);
    squared_error += error * error;
    squared_exact += (scale_exact * exact[p]) * (scale_exact * exact[p]);
  }
  norms.rms = std::sqrt(squared_error / static_cast<double>(numerical.size())) / scale_error;
  if (squared_exact == 0.0)
    norms.relative_l2 = norms.rms;
  else if (scale_error == scale_exact)
    norms.relative_l2 = std::sqrt(squared_error / squared_exact);
  else
    norms.relative_l2 = std::sqrt(squared_error) / scale_error / (std::sqrt(squared_exact) / scale_exact);
  if (std::isnan(norms.rms)) norms.max = norms.rms;  // max() passes over NaN, the sums do not
  return norms;
}

namespace {

/// Whether the stress has a jump: between two neighbours a quarter of all that it varies.
bool has_shock(const std::vector<double>& stress) {
  constexpr std::size_t enough = 16;  // points, of which smooth fields show less
  if (stress.size() < enough) return false;
  const auto [least, most] = std::ranges::minmax(stress);
  double jump = 0.0;
  for (std::size_t i = 1; i < stress.size(); ++i) jump = std::max(jump, std::abs(stress[i] - stress[i - 1]));
  return jump > 0.25 * (most - least);
}

}  // namespace

std::optional<ReferenceFields> detail::sound_fields(const Reference& reference, double time,
                                                    std::span<const double> X, std::string& reason) {
  try {
    ReferenceFields fields = reference.at(time, X);
    // Past a shock, or with loads too fine for it, the reference does not converge: its own error says so.
    const double own = reference.estimated_error().displacement;
    if (own <= 1e-3) return fields;
    reason = "the reference solution (" + reference.description + ") is only good to " + to_text(own) +
             " here" +
             (reference.steepens && has_shock(fields.stress) ? ": the motion has steepened to a shock"
                                                             : ", compared with half its resolution");
  } catch (const Error& error) {
    reason = error.what();
  }
  return std::nullopt;
}

double detail::rms(const std::vector<double>& values) {
  return error_norms(values, std::vector<double>(values.size())).rms;
}

namespace {

/// The size of each field; of a part without its mean, which says nothing of strains where all of a body
/// moves.
ReferenceErrors sizes(const ReferenceFields& fields, bool without_mean = false) {
  ReferenceErrors sizes;
  for (const ErrorField& field : error_fields) {
    std::vector<double> values = fields.*field.exact;
    double mean = 0.0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    if (without_mean && field.exact != &ReferenceFields::stress)
      for (double& value : values) value -= mean;
    sizes.*field.error = detail::rms(values);
  }
  return sizes;
}

/// How large each field is to be expected by the others: a wave has strain v/c, over the body the
/// displacement L v/c. The least of all bodies.
ReferenceErrors expected(const Scene& scene, const ReferenceErrors& size) {
  constexpr double most = std::numeric_limits<double>::infinity();
  ReferenceErrors least{most, most, most};
  for (const Scene* body : bodies_of(scene)) {
    const double E = body->material.youngs_modulus;
    const double c = std::sqrt(E / body->material.density);
    const double L = body->body.length;
    const double u = size.displacement / L;
    const double v = size.velocity / c;
    const double s = size.stress / E;
    least.displacement = std::min(least.displacement, L * std::max(v, s));
    least.velocity = std::min(least.velocity, c * std::max(u, s));
    least.stress = std::min(least.stress, E * std::max(u, v));
  }
  return least;
}

/// How often the values turn, by more than a tenth of all that they vary.
double turns(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto [least, most] = std::ranges::minmax(values);
  const double enough = 0.1 * (most - least);
  double count = 0.0;
  double low = values.front();
  double high = low;
  for (double way = 0.0; const double value : values) {
    low = std::min(low, value);
    high = std::max(high, value);
    const bool up = way <= 0.0 && value > low + enough;
    if (up || (way >= 0.0 && value < high - enough)) {
      count += way != 0.0 ? 1.0 : 0.0;
      way = up ? 1.0 : -1.0;
      low = high = value;
    }
  }
  return count;
}

}  // namespace

void RunMotion::look(const Scene& scene, const Snapshot& snapshot) {
  for (const ErrorField& field : error_fields)
    largest.*field.error = std::max(largest.*field.error, detail::rms(snapshot.*field.values));
  const std::vector<const Scene*> bodies = bodies_of(scene);
  std::vector<double> cells;
  for (std::size_t i = 0; i < snapshot.size(); ++i) {
    const Scene& body = *bodies[snapshot.body.empty() ? 0 : static_cast<std::size_t>(snapshot.body[i])];
    cells.push_back(std::floor((snapshot.position[i] - body.body.left()) / body.body.length *
                               static_cast<double>(body.scheme.cells)));
    if (cells_.size() == snapshot.size() && cells.back() != cells_[i]) ++crossings;
  }
  cells_ = std::move(cells);
}

ErrorReport detail::report_of(const Scene& scene, const Snapshot& snapshot, const ReferenceFields& fields,
                              const ReferenceErrors& own, const RunMotion& motion) {
  ErrorReport report;
  const ReferenceErrors size = sizes(fields);
  const ReferenceErrors all = expected(scene, size);
  const ReferenceErrors strained = expected(scene, sizes(fields, true));
  for (const ErrorField& field : error_fields) {
    const ErrorNorms& error = report.*field.norms = error_norms(snapshot.*field.values, fields.*field.exact);
    double scale = size.*field.error;
    if (constexpr double vanishing = 0.1; scale < vanishing * motion.largest.*field.error) {
      report.notes.push_back(std::string("the ") + field.name + " is small at the end, rms " +
                             to_text(scale) + " " + field.unit +
                             ": its bound is over the largest rms that it had, " +
                             to_text(motion.largest.*field.error) + " " + field.unit);
      scale = motion.largest.*field.error;
    }
    constexpr double of_rounding = 1e-9;
    scale = std::max({scale, 1e-3 * strained.*field.error, of_rounding * all.*field.error});
    const double unit = scale > 0.0 ? scale : 1.0;
    report.bound.*field.error = (error.rms + own.*field.error) / unit;
    report.reference_errors.*field.error = own.*field.error / unit;
  }
  for (std::size_t first = 0, i = 1; i <= snapshot.size(); ++i) {  // body by body
    if (i < snapshot.size() && (snapshot.body.empty() || snapshot.body[i] == snapshot.body[first])) continue;
    const double* const stress = fields.stress.data();
    std::vector<double> slopes(stress + first, stress + i);
    report.jump = report.jump || has_shock(slopes);
    std::adjacent_difference(stress + first, stress + i, slopes.begin());
    report.kink = report.kink || has_shock({slopes.begin() + 1, slopes.end()});
    first = i;
  }
  double cells = 0.0;
  for (const Scene* body : bodies_of(scene)) cells += body->scheme.cells;
  report.cells_per_wave = cells / (1.0 + turns(fields.stress));
  return report;
}

std::optional<ErrorReport> judge(const Scene& scene, const RunResult& result, std::string& reason,
                                 const ReferenceWatch& watch, const RunMotion& motion) {
  const std::optional<Reference> reference = make_reference(scene, watch);
  if (!reference) {
    reason = "no reference solution is known for this scene";
    return std::nullopt;
  }
  if (scene.rest && !result.at_rest) {
    reason = "the body had not come to rest by the end time; the reference is the state of rest";
    return std::nullopt;
  }
  const Snapshot& final = result.final;
  const auto exact = detail::sound_fields(*reference, final.time, final.reference_position, reason);
  if (!exact) return std::nullopt;
  const ReferenceErrors relative = reference->estimated_error();
  const ReferenceErrors size = sizes(*exact);
  const ReferenceErrors all = expected(scene, size);
  ReferenceErrors own;  // what was relative to a field, or to a thousandth of what the others make one expect
  for (const ErrorField& field : error_fields)
    own.*field.error = relative.*field.error * std::max(size.*field.error, 1e-3 * all.*field.error);
  ErrorReport report = detail::report_of(scene, final, *exact, own, motion);
  report.reference = reference->description;
  report.reference_errors = relative;
  report.kind = relative.displacement > 0.0 ? ErrorKind::computed : ErrorKind::exact;
  return report;
}

}  // namespace hompm
