#include <algorithm>
#include <cmath>
#include <string>

#include <hompm/error.hpp>
#include <hompm/verify/error_norms.hpp>

namespace hompm {

ErrorNorms error_norms(std::span<const double> numerical, std::span<const double> exact) {
  if (numerical.size() != exact.size()) {
    throw Error("error norms of " + std::to_string(numerical.size()) + " values against " +
                std::to_string(exact.size()));
  }
  if (numerical.empty()) return {};
  double squared_error = 0.0;
  double squared_exact = 0.0;
  ErrorNorms norms;
  for (std::size_t p = 0; p < numerical.size(); ++p) {
    const double error = numerical[p] - exact[p];
    squared_error += error * error;
    squared_exact += exact[p] * exact[p];
    norms.max = std::max(norms.max, std::abs(error));
  }
  norms.rms = std::sqrt(squared_error / static_cast<double>(numerical.size()));
  norms.relative_l2 = squared_exact == 0.0 ? norms.rms : std::sqrt(squared_error / squared_exact);
  if (std::isnan(norms.rms)) norms.max = norms.rms;  // max() passes over NaN, the sums do not
  return norms;
}

}  // namespace hompm
