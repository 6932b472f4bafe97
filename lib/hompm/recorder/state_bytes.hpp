// All fields of a state as bytes that mean the same on every machine.
#pragma once

#include <hompm/plan/state.hpp>
#include <hompm/recorder/bytes.hpp>

namespace hompm::detail {

/// Appends every field of the state, with its name and its number of values.
void write_state(ByteWriter& out, const State& state);

/// Reads what `write_state` wrote into a state of the same scene. Throws `Error` when a field is not what the
/// scene makes it, and `BytesEnd`.
void read_state(ByteReader& in, State& state);

inline void read_value(ByteReader& in, double& value) { value = in.number(); }
inline void read_value(ByteReader& in, std::integral auto& value) {
  value = static_cast<std::remove_reference_t<decltype(value)>>(in.word());
}

}  // namespace hompm::detail
