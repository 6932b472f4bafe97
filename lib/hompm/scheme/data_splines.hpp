// The splines through particle data.
#pragma once

#include <type_traits>

#include <hompm/numerics/cubic_spline.hpp>
#include <hompm/numerics/interpolating_spline.hpp>

namespace hompm::detail {

/// Of a degree that keeps the order of a basis of degree P: a cubic does up to P = 3.
template <int P>
using MatchingSplines =
    std::conditional_t<(P > 3), numerics::InterpolatingSplineSites<5>, numerics::CubicSplineSites>;

}  // namespace hompm::detail
