// Numbers with a unit: "25 kPa", "1.6 g/cm3".
#pragma once

#include <optional>
#include <string>

namespace hompm::detail {

struct ConvertedNumber {
  std::optional<double> value;  ///< in the unit that is wanted
  std::string reason = {};      ///< why there is none; "" where the text is no number and a unit at all
};

/// What the text is in the unit `wanted` ("Pa", "kg/m³"; "" for a pure number). Units differ by powers of
/// ten, so the value is that of the decimal with another exponent, correctly rounded: "25 kPa" has the bits
/// of 25e3.
ConvertedNumber converted(const std::string& text, const std::string& wanted);

}  // namespace hompm::detail
