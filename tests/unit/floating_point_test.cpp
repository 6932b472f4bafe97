#include <cfenv>
#include <string>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <hompm/error.hpp>
#include <hompm/numerics/floating_point.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"

using hompm::numerics::check_floating_point;
using hompm::test::message_of;

TEST_CASE("this build and process compute as IEEE 754 says, and a changed rounding mode is refused") {
  CHECK_NOTHROW(check_floating_point());
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    const std::string message = message_of<hompm::ArithmeticError>(check_floating_point);
    std::fesetround(FE_TONEAREST);
    CHECK(message == "the rounding mode is not to nearest");
  }
}

#if defined(__SSE2__)
TEST_CASE("a process that flushes subnormal numbers to zero is refused") {
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | _MM_FLUSH_ZERO_ON);
  const std::string message = message_of<hompm::ArithmeticError>(check_floating_point);
  _mm_setcsr(before);
  CHECK(message.starts_with("subnormal numbers are flushed to zero here"));
}
#endif
