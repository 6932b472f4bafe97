#include <cfenv>

#include <hompm/error.hpp>
#include <hompm/numerics/floating_point.hpp>

#include "support/catch.hpp"

using hompm::numerics::check_floating_point;

TEST_CASE("this build and process compute as IEEE 754 says, and a changed rounding mode is refused") {
  CHECK_NOTHROW(check_floating_point());
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    bool refused = false;
    try {
      check_floating_point();
    } catch (const hompm::Error&) {
      refused = true;
    }
    std::fesetround(FE_TONEAREST);
    CHECK(refused);
  }
}
