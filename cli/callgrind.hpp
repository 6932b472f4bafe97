// Counts instructions of time steps by running them in a child process under valgrind.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <hompm/study/measure.hpp>

namespace hompm::cli {

/// Whether valgrind is there and can run this program; not when it is built with the address sanitizer.
bool has_callgrind();

/// Path of the running program.
std::string program_path();

/// FNV-1a of the running program's file, in hex: the same for one build, another for any other.
std::string program_id();

/// Instructions in a few steps from the measured states: those of `Simulation::step`, to the digit. Throws
/// `Error` with what the child said when it fails, and what `check` throws, which is called while waiting and
/// ends the child.
study::Instructions count_instructions(const study::Measured& measured, const study::Check& check);

}  // namespace hompm::cli
