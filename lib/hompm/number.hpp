// Numbers as text: the shortest decimal that reads back to the same bits.
#pragma once

#include <string>

namespace hompm {

/// Shortest text that `std::from_chars` reads back to exactly `value` (`std::to_chars`), the same bytes on
/// every machine. Throws `Error` for a value that is not finite: such a value must never reach a file.
std::string to_text(double value);

/// Appends `to_text(value)` to `out` without a temporary.
void append_text(std::string& out, double value);

}  // namespace hompm
