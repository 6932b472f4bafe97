#include <cmath>
#include <limits>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/verify/judge.hpp>

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
