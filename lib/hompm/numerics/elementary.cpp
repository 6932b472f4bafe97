#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include <hompm/numerics/elementary.hpp>

namespace hompm::numerics {
namespace {

using Quad = boost::multiprecision::cpp_bin_float_quad;

double rounded(const Quad& value) { return value.convert_to<double>(); }

Quad times_pi(double x) { return boost::math::constants::pi<Quad>() * x; }

/// x = n + remainder exactly, n an integer, |remainder| ≤ 1/2.
struct Turns {
  bool odd;  ///< n is odd
  double remainder;
};

Turns half_turns(double x) {
  const double size = x < 0.0 ? -x : x;
  if (!(size < 0x1p53)) return {false, x - x};    // even; or not a number, and stays so
  const double half = size < 0x1p52 ? 0.5 : 0.0;  // from 2^52 on, x is an integer
  const auto n = static_cast<std::int64_t>(x < 0.0 ? x - half : x + half);
  return {n % 2 != 0, x - static_cast<double>(n)};
}

/// The unevaluated sum high + low, |low| ≤ ulp(high)/2: 106 bits from + − × ÷ alone (Dekker 1971, Knuth).
struct DoubleDouble {
  double high;
  double low = 0.0;
};

/// a + b exactly, for |a| ≥ |b| or a = 0.
constexpr DoubleDouble quick_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a + b exactly.
constexpr DoubleDouble two_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

/// a × b exactly, by Veltkamp's splitting into halves of 26 bits.
constexpr DoubleDouble two_product(double a, double b) {
  constexpr double splitter = 0x1p27 + 1.0;
  const double ta = splitter * a;
  const double tb = splitter * b;
  const double a_high = ta - (ta - a);
  const double b_high = tb - (tb - b);
  const double a_low = a - a_high;
  const double b_low = b - b_high;
  const double product = a * b;
  return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

constexpr DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble high = two_sum(a.high, b.high);
  const DoubleDouble low = two_sum(a.low, b.low);
  const DoubleDouble sum = quick_two_sum(high.high, high.low + low.high);
  return quick_two_sum(sum.high, sum.low + low.low);
}

constexpr DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble product = two_product(a.high, b.high);
  return quick_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

constexpr DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
  const double first = a.high / b.high;
  const DoubleDouble rest = a + DoubleDouble{-first} * b;
  return quick_two_sum(first, rest.high / b.high);
}

constexpr DoubleDouble ln2{0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};

// log(m) for m in [1, 2): the leading 7 bits of the mantissa choose a c near 1/m with at most 9 bits, so that
// m c − 1 is small (below 2^-7) and exact, and log(m) = log(m c) − log(c). Where m > √2, log(m/2) is used
// instead, so that nothing cancels near x = 1.
constexpr std::size_t table_bits = 7;
constexpr std::size_t table_size = std::size_t{1} << table_bits;

struct TableEntry {
  double reciprocal;       ///< c, 1 for the first entry, 1/2 for the last
  DoubleDouble minus_log;  ///< −log(c), or −log(2c) for the upper part
  bool upper;              ///< m is above √2
};

// LCOV_EXCL_START: the compiler evaluates it, and no counter sees that; the unit tests check the table by its
// logarithms
/// log(x) of an x within [1/2, 2], by the whole series 2 artanh((x − 1)/(x + 1)); for the table.
constexpr DoubleDouble series_log(double x) {
  const DoubleDouble s = DoubleDouble{x - 1.0} / DoubleDouble{x + 1.0};
  const DoubleDouble w = s * s;
  DoubleDouble sum{0.0};
  for (int k = 45; k >= 1; k -= 2) sum = sum * w + DoubleDouble{1.0} / DoubleDouble{static_cast<double>(k)};
  return DoubleDouble{2.0} * s * sum;
}

constexpr std::array<TableEntry, table_size> make_table() {
  std::array<TableEntry, table_size> table{};
  for (std::size_t i = 0; i < table_size; ++i) {
    const std::size_t parts = 32768 / (table_size + i);  // whole, so that c has few digits
    const double c = static_cast<double>(parts) / 256.0;
    const bool upper = i > 52;
    const DoubleDouble log_c = series_log(upper ? 2.0 * c : c);
    table[i] = {c, {-log_c.high, -log_c.low}, upper};
  }
  return table;
}

// LCOV_EXCL_STOP

constexpr std::array<TableEntry, table_size> table = make_table();

/// log(1 + r) for |r| ≤ 2^-7: with s = r/(2 + r) the series 2s (1 + w/3 + w²/5 + …), w = s² < 2^-15. The
/// further a term stands behind, the fewer of its bits count: from w³/7 on a double is enough.
DoubleDouble log_one_plus(DoubleDouble r) {
  constexpr DoubleDouble third = DoubleDouble{1.0} / DoubleDouble{3.0};
  constexpr DoubleDouble fifth = DoubleDouble{1.0} / DoubleDouble{5.0};
  const DoubleDouble s = r / (DoubleDouble{2.0} + r);
  const DoubleDouble w = s * s;
  const double tail = 1.0 / 7.0 + w.high * (1.0 / 9.0 + w.high * (1.0 / 11.0 + w.high * (1.0 / 13.0)));
  const DoubleDouble series = third + w * (fifth + w * DoubleDouble{tail});
  const DoubleDouble twice{2.0 * s.high, 2.0 * s.low};
  return twice + twice * (w * series);
}

constexpr DoubleDouble pi_in_two{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};

/// ±1/(2k + 1)!, of the series of the sine; what is left out is below 2^-119 of it up to π/2.
constexpr auto sine_coefficients = [] {
  std::array<DoubleDouble, 18> coefficients{};
  coefficients[0] = {1.0};
  for (std::size_t k = 1; k < coefficients.size(); ++k) {
    const auto divisor = static_cast<double>(2 * k * (2 * k + 1));
    coefficients[k] = coefficients[k - 1] / DoubleDouble{-divisor};
  }
  return coefficients;
}();

/// sin(πr) for |r| ≤ 1/2, rounded once. In double-double, with an error far below 2^-90; where that could
/// round either way (Ziv 1991), or parts of products underflow, with 113 bits.
double sin_of_half_turn(double r) {
  if (r > 0x1p-900 || r < -0x1p-900) {
    const DoubleDouble angle = pi_in_two * DoubleDouble{r};
    const DoubleDouble square = angle * angle;
    DoubleDouble sum = sine_coefficients.back();
    for (std::size_t k = sine_coefficients.size() - 1; k-- > 0;) sum = sum * square + sine_coefficients[k];
    const DoubleDouble sine = angle * sum;
    const double error = 0x1p-90 * sine.high;
    if (sine.high + (sine.low + error) == sine.high + (sine.low - error)) return sine.high + sine.low;
  }
  return rounded(boost::multiprecision::sin(times_pi(r)));
}

}  // namespace

double sin(double x) { return rounded(boost::multiprecision::sin(Quad(x))); }

double cos(double x) { return rounded(boost::multiprecision::cos(Quad(x))); }

double exp(double x) { return rounded(boost::multiprecision::exp(Quad(x))); }

double sin_pi(double x) {
  const Turns turns = half_turns(x);
  const double value = sin_of_half_turn(turns.remainder);
  return turns.odd ? 0.0 - value : value;  // never −0
}

double cos_pi(double x) {
  const Turns turns = half_turns(x);
  // Near a quarter turn through the sine, whose argument is then small and exact: cos_pi(1/2) is exactly 0.
  const double distance = turns.remainder < 0.0 ? -turns.remainder : turns.remainder;
  const double value = distance > 0.25 ? sin_of_half_turn(0.5 - distance)
                                       : rounded(boost::multiprecision::cos(times_pi(distance)));
  return turns.odd ? 0.0 - value : value;  // never −0
}

double log(double x) {
  if (!(x > 0.0 && x <= std::numeric_limits<double>::max())) return std::numeric_limits<double>::quiet_NaN();
  int exponent = -1023;
  if (x < std::numeric_limits<double>::min()) {
    x *= 0x1p54;
    exponent -= 54;
  }
  const auto bits = std::bit_cast<std::uint64_t>(x);
  constexpr std::uint64_t mantissa_mask = (std::uint64_t{1} << 52U) - 1;
  exponent += static_cast<int>(bits >> 52U);
  const auto m = std::bit_cast<double>((bits & mantissa_mask) | (std::uint64_t{1023} << 52U));

  const TableEntry& entry = table[(bits & mantissa_mask) >> (52U - table_bits)];
  const DoubleDouble product = two_product(m, entry.reciprocal);
  const DoubleDouble logarithm =
      entry.minus_log + log_one_plus(quick_two_sum(product.high - 1.0, product.low));
  const double powers = static_cast<double>(entry.upper ? exponent + 1 : exponent);
  return (ln2 * DoubleDouble{powers} + logarithm).high;
}

}  // namespace hompm::numerics
