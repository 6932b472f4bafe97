// Which mistake would explain how another code's results differ.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <hompm/scene/scene.hpp>
#include <hompm/verify/foreign_comparison.hpp>

namespace hompm::detail {

/// One sentence for each mistake that explains most of a difference: units, signs, a column that holds
/// another field, times off by a step, velocities off by half a one, few digits, another amplitude, other
/// particles. `times_a` and `times_b` (s, ascending) are those of the file and those looked for.
std::vector<std::string> mistakes(const ForeignComparison& found, const std::vector<double>& times_a,
                                  const std::vector<double>& times_b, const std::optional<Scene>& scene);

}  // namespace hompm::detail
