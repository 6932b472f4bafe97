// In place of the library's header of this name, whose includes take most of the time to compile the kernel.
#pragma once

#include <stdexcept>

namespace hompm {

struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};
struct ArithmeticError : Error {
  using Error::Error;
};

}  // namespace hompm
