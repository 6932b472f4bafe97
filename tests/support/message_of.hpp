// Text in tests: what an error says, and whether it says the right thing.
#pragma once

#include <string>

namespace hompm::test {

/// what() of the error of type `Failure` that `work` throws; "" when it throws none.
template <class Failure, class Work>
std::string message_of(Work work) {
  try {
    work();
  } catch (const Failure& error) {
    return error.what();
  }
  return "";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != text.npos;
}

}  // namespace hompm::test
