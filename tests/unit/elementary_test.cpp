#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include <hompm/numerics/elementary.hpp>

#include "support/catch.hpp"

namespace {

namespace numerics = hompm::numerics;
using Precise = boost::multiprecision::cpp_bin_float_50;

double rounded(const Precise& value) { return value.convert_to<double>(); }

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

/// Numbers in [0, 1) from the generator alone: the standard distributions differ between libraries.
class Uniform {
 public:
  double operator()() { return static_cast<double>(generator_() >> 11U) * 0x1p-53; }
  int below(int n) { return static_cast<int>((*this)() * n); }

 private:
  std::mt19937_64 generator_{20240229};
};

}  // namespace

TEST_CASE("log is the correctly rounded logarithm", "[elementary]") {
  Uniform uniform;
  int wrong = 0;
  for (int i = 0; i < 20000; ++i) {
    double x = 0.0;
    if (i % 3 == 0) x = 1.0 + (uniform() - 0.5) * std::ldexp(1.0, -uniform.below(52));  // near its zero
    if (i % 3 == 1) x = 0.01 + 5.0 * uniform();                                         // stretches
    if (i % 3 == 2) x = std::ldexp(1.0 + uniform(), uniform.below(2090) - 1070);        // subnormal to large
    const Precise exact = boost::multiprecision::log(Precise(x));
    if (numerics::log(x) != rounded(exact)) ++wrong;
  }
  CHECK(wrong == 0);
}

TEST_CASE("log is correctly rounded in hard cases", "[elementary]") {
  // The worst of 10⁹ numbers in (1, 1.01) and [0.25, 4.25): their logarithms lie within 2^-26 to 2^-30 ulp of
  // the middle between two doubles, so that an error of 2^-80 would round some of them wrongly.
  for (const double x :
       {0x1.017fcaa0b71aep+0, 0x1.01084a4f61085p+0, 0x1.01612d7f90394p+0, 0x1.003d05034d77fp+0,
        0x1.52ed3b5e54f32p+1, 0x1.3816e1ffdad03p+1, 0x1.65834fa4edb06p+0, 0x1.4d8199fb604afp+1,
        0x1.f76661380b68ep+0, 0x1.ee69d73daabb6p+0, 0x1.503ff787b6b33p+1}) {
    CHECK(numerics::log(x) == rounded(boost::multiprecision::log(Precise(x))));
  }
}

TEST_CASE("log at the edges of its domain", "[elementary]") {
  CHECK(bits(numerics::log(1.0)) == bits(0.0));
  for (const double x :
       {std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::min(),
        std::numeric_limits<double>::max(), std::nextafter(1.0, 0.0), std::nextafter(1.0, 2.0)}) {
    CHECK(numerics::log(x) == rounded(boost::multiprecision::log(Precise(x))));
  }
  CHECK(std::isnan(numerics::log(0.0)));
  CHECK(std::isnan(numerics::log(-1.0)));
  CHECK(std::isnan(numerics::log(std::numeric_limits<double>::quiet_NaN())));
}

TEST_CASE("sin, cos, exp, sin_pi and cos_pi are correctly rounded", "[elementary]") {
  Uniform uniform;
  for (int i = 0; i < 500; ++i) {
    const double x = 40.0 * (uniform() - 0.5);
    const Precise turn = boost::math::constants::pi<Precise>() * x;
    INFO("x = " << x);
    CHECK(numerics::sin(x) == rounded(boost::multiprecision::sin(Precise(x))));
    CHECK(numerics::cos(x) == rounded(boost::multiprecision::cos(Precise(x))));
    CHECK(numerics::exp(x) == rounded(boost::multiprecision::exp(Precise(x))));
    CHECK(numerics::sin_pi(x) == rounded(boost::multiprecision::sin(turn)));
    CHECK(numerics::cos_pi(x) == rounded(boost::multiprecision::cos(turn)));
  }
}

TEST_CASE("sin_pi is the correctly rounded sine of any turn, however small", "[elementary]") {
  Uniform uniform;
  int wrong = 0;
  for (int i = 0; i < 5000; ++i) {
    double x = 2.0 * (uniform() - 0.5);
    if (i % 3 == 1) x *= std::ldexp(1.0, -uniform.below(1020));
    if (i % 3 == 2) x += uniform.below(1000000);
    const Precise exact =
        boost::multiprecision::sin(boost::math::constants::pi<Precise>() * std::fmod(x, 2.0));
    if (numerics::sin_pi(x) != rounded(exact)) ++wrong;
  }
  CHECK(wrong == 0);
}

TEST_CASE("sin_pi and cos_pi are exact where their values are", "[elementary]") {
  for (const double n : {0.0, 1.0, 2.0, 3.0, 1e6, 0x1p52, 0x1p52 + 1.0, 0x1p53 - 1.0, 0x1p60}) {
    const double parity = std::fmod(n, 2.0) == 0.0 ? 1.0 : -1.0;
    INFO("n = " << n);
    CHECK(bits(numerics::sin_pi(n)) == bits(0.0));
    CHECK(numerics::sin_pi(-n) == 0.0);
    CHECK(numerics::cos_pi(n) == parity);
    CHECK(numerics::cos_pi(-n) == parity);
  }
  for (const double n : {0.0, 1.0, 2.0, 3.0, -1.0, 1e6}) {
    const double parity = std::fmod(n, 2.0) == 0.0 ? 1.0 : -1.0;
    CHECK(numerics::cos_pi(n + 0.5) == 0.0);
    CHECK(numerics::sin_pi(n + 0.5) == parity);
  }
  for (int k = 1; k < 2000; ++k) {  // near a zero that no double but 1/2 hits
    const double x = 0.5 + k * 0x1p-52;
    CHECK(numerics::cos_pi(x) ==
          rounded(-boost::multiprecision::sin(boost::math::constants::pi<Precise>() * (k * 0x1p-52))));
  }
  CHECK(std::isnan(numerics::sin_pi(std::numeric_limits<double>::infinity())));
}
