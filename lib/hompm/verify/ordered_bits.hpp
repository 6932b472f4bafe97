// Doubles as integers that grow with the value.
#pragma once

#include <bit>
#include <cstdint>

namespace hompm::detail {

/// The next double up is the next integer up; −0 comes right before +0.
inline std::uint64_t ordered_bits(double value) {
  constexpr std::uint64_t sign = std::uint64_t{1} << 63;
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return (bits & sign) != 0 ? ~bits : bits | sign;
}

}  // namespace hompm::detail
