#include <algorithm>
#include <cmath>
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

std::optional<ErrorReport> judge(const Scene& scene, const RunResult& result, std::string& reason,
                                 const ReferenceWatch& watch) {
  const std::optional<Reference> reference = make_reference(scene, watch);
  if (!reference) {
    reason = "no reference solution is known for this scene";
    return std::nullopt;
  }
  if (scene.rest && !result.at_rest) {
    reason = "the body had not come to rest by the end time; the reference is the state of rest";
    return std::nullopt;
  }
  const auto exact =
      detail::sound_fields(*reference, result.final.time, result.final.reference_position, reason);
  if (!exact) return std::nullopt;
  return ErrorReport{.reference = reference->description,
                     .reference_errors = reference->estimated_error(),
                     .displacement = error_norms(result.final.displacement, exact->displacement),
                     .velocity = error_norms(result.final.velocity, exact->velocity),
                     .stress = error_norms(result.final.stress, exact->stress)};
}

}  // namespace hompm
