#include <cmath>
#include <limits>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/kit/verify/judge.hpp>

#include "support/catch.hpp"

using hompm::error_norms;
using Values = std::vector<double>;

TEST_CASE("error norms of a known difference are exact", "[error_norms]") {
  const auto norms = error_norms(Values{4.0, 0.0, 2.0, 2.0}, Values{1.0, 4.0, 2.0, 2.0});
  CHECK(norms.max == 4.0);
  CHECK(norms.rms == 2.5);          // √(25/4)
  CHECK(norms.relative_l2 == 1.0);  // √(25/25)
}

TEST_CASE("error norms do not divide by a vanishing exact field", "[error_norms]") {
  const auto zero = error_norms(Values{0.0, 0.0}, Values{0.0, 0.0});
  CHECK(zero.relative_l2 == 0.0);
  CHECK(zero.rms == 0.0);
  CHECK(zero.max == 0.0);
  const auto absolute = error_norms(Values{3.0, -3.0}, Values{0.0, 0.0});
  CHECK(absolute.relative_l2 == 3.0);
  CHECK(absolute.rms == 3.0);
  CHECK(error_norms(Values{}, Values{}).max == 0.0);
}

TEST_CASE("error norms of tiny and huge fields are those of others, scaled", "[error_norms]") {
  // Squares of 2^-600 vanish, those of 2^600 are infinite; 2^-1060 is subnormal.
  for (const double scale : {0x1p-1060, 0x1p-600, 0x1p600, 0x1p1000}) {
    const auto norms = error_norms(Values{4.0 * scale, 0.0, 3.0 * scale}, Values{0.0, -12.0 * scale, 0.0});
    CHECK(norms.max == 12.0 * scale);
    CHECK(norms.rms == std::sqrt(169.0 / 3.0) * scale);
    CHECK(norms.relative_l2 == std::sqrt(169.0 / 144.0));
  }
  const auto small = error_norms(Values{2.0 + 0x1p-51}, Values{2.0});
  CHECK(small.relative_l2 == 0x1p-52);
  CHECK(error_norms(Values{0x1p1000}, Values{0x1p1000}).rms == 0.0);
}

TEST_CASE("no error norm of a field with a NaN passes any bound", "[error_norms]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& values : {Values{nan, 1.0, 1.0}, Values{1.0, nan, 1.0}, Values{1.0, 1.0, nan}}) {
    const auto norms = error_norms(values, Values{1.0, 1.0, 1.0});
    CHECK(std::isnan(norms.max));
    CHECK(std::isnan(norms.rms));
    CHECK(std::isnan(norms.relative_l2));
  }
}

TEST_CASE("error norms refuse fields of different length", "[error_norms]") {
  CHECK_THROWS_AS(error_norms(Values{1.0}, Values{1.0, 2.0}), hompm::Error);
}
