// What each effect that can only take energy has taken.
#pragma once

#include <string_view>

namespace hompm::detail {

/// Fields "body.taken", "body.taken_2" … hold it, J/m²; their meaning names the effect.
inline constexpr std::string_view taken_by_effect = "taken";

}  // namespace hompm::detail
