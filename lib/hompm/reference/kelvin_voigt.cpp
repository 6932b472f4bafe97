#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <hompm/numerics/elementary.hpp>
#include <hompm/reference/kelvin_voigt.hpp>

namespace hompm {
namespace {

/// std::complex divides by a routine of the compiler, whose last bits differ.
struct Complex {
  double re = 0.0;
  double im = 0.0;

  friend Complex operator+(Complex a, Complex b) { return {a.re + b.re, a.im + b.im}; }
  friend Complex operator-(Complex a, Complex b) { return {a.re - b.re, a.im - b.im}; }
  friend Complex operator*(double a, Complex b) { return {a * b.re, a * b.im}; }
  friend Complex operator*(Complex a, Complex b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
  }
  friend Complex operator/(Complex a, Complex b) {
    return (1.0 / (b.re * b.re + b.im * b.im)) * (a * Complex{b.re, -b.im});
  }
};

Complex exp(Complex z) {
  constexpr double nothing_left = -745.0;  // e^x is 0 in double precision
  if (z.re < nothing_left) return {};
  const double size = numerics::exp(z.re);
  if (z.im == 0.0) return {size, 0.0};
  return {size * numerics::cos(z.im), size * numerics::sin(z.im)};
}

constexpr std::size_t ramp_degree = 9;  // of the smooth step
using Polynomial = std::array<double, ramp_degree + 1>;

/// Σ c_j ∫₀¹ e^{z(1 − s)} s^j ds.
Complex integral(Complex z, const Polynomial& c) {
  std::array<Complex, ramp_degree + 1> of{};
  const double size = std::abs(z.re) + std::abs(z.im);
  if (size >= ramp_degree + 1.0) {  // by parts, from j = 0 upwards
    of[0] = (exp(z) - Complex{1.0, 0.0}) / z;
    for (std::size_t j = 1; j <= ramp_degree; ++j)
      of[j] = (static_cast<double>(j) * of[j - 1] - Complex{1.0, 0.0}) / z;
  } else {  // the series of the last one, and by parts downwards
    Complex term{1.0 / (ramp_degree + 1.0), 0.0};
    for (int m = 1; m <= 70; ++m) {
      of[ramp_degree] = of[ramp_degree] + term;
      term = (1.0 / (ramp_degree + 1.0 + m)) * (term * z);
    }
    for (std::size_t j = ramp_degree; j > 0; --j)
      of[j - 1] = (1.0 / static_cast<double>(j)) * (z * of[j] + Complex{1.0, 0.0});
  }
  Complex sum;
  for (std::size_t j = 0; j <= ramp_degree; ++j) sum = sum + c[j] * of[j];
  return sum;
}

/// Where an amplitude without its oscillation is one polynomial of (time − from)/(to − from).
struct Piece {
  double from;
  double to;
  Polynomial factor;
  [[nodiscard]] double width() const { return to - from; }
};

/// The smooth step of x = at + slope s, as a polynomial of s.
Polynomial step_polynomial(double at, double slope) {
  constexpr Polynomial powers{0.0, 0.0, 0.0, 0.0, 0.0, 126.0, -420.0, 540.0, -315.0, 70.0};
  Polynomial p{};
  for (std::size_t j = ramp_degree + 1; j-- > 0;) {  // Horner's rule, of polynomials
    for (std::size_t i = ramp_degree; i > 0; --i) p[i] = at * p[i] + slope * p[i - 1];
    p[0] = at * p[0] + powers[j];
  }
  return p;
}

/// The pieces up to `time`. A load that ends has grown before it goes.
std::vector<Piece> pieces_of(const Amplitude& amplitude, double time) {
  const double rise = amplitude.ramp_time;
  const double end = amplitude.duration > 0.0 ? std::min(amplitude.duration, time) : time;
  std::vector<Piece> pieces;
  const auto add = [&](double from, double to, const Polynomial& whole, bool grows, bool falls) {
    to = std::min(to, end);
    if (!(to > from)) return;
    Polynomial factor = whole;
    if (grows) factor = step_polynomial(from / rise, (to - from) / rise);
    if (falls) factor = step_polynomial((amplitude.duration - from) / rise, (from - to) / rise);
    pieces.push_back({from, to, factor});
  };
  const Polynomial one{1.0};
  const double fall = amplitude.duration > 0.0 ? amplitude.duration - rise : time;
  if (rise > 0.0) add(0.0, rise, one, true, false);
  add(rise, fall, one, false, false);
  if (amplitude.duration > 0.0) add(fall, amplitude.duration, one, false, rise > 0.0);
  return pieces;
}

/// The load at a time, and what an exponential makes of its past.
class History {
 public:
  History(const Amplitude& amplitude, double time)
      : now(amplitude(time)),
        frequency_(amplitude.frequency),
        time_(time),
        pieces_(pieces_of(amplitude, time)) {}

  /// ∫₀ᵗ e^{λ(t − s)} p(s) ds
  [[nodiscard]] Complex past(Complex rate) const {
    Complex sum;
    for (const Piece& piece : pieces_) {
      const Complex decay = exp((time_ - piece.to) * rate);
      const Complex z = piece.width() * rate;
      Complex over = integral(z, piece.factor);
      if (frequency_ > 0.0) {  // sin is the difference of two exponentials, over 2i
        const double phase = 2.0 * frequency_ * piece.to;
        const double turn = 2.0 * numerics::pi * frequency_ * piece.width();
        const Complex ahead{numerics::cos_pi(phase), numerics::sin_pi(phase)};
        const Complex behind{ahead.re, -ahead.im};
        const Complex both = ahead * integral(z - Complex{0.0, turn}, piece.factor) -
                             behind * integral(z + Complex{0.0, turn}, piece.factor);
        over = {0.5 * both.im, -0.5 * both.re};
      }
      sum = sum + piece.width() * (decay * over);
    }
    return sum;
  }

  double now;

 private:
  double frequency_;
  double time_;
  std::vector<Piece> pieces_;
};

/// q̈ + damping q̇ + stiffness q = load: position and velocity.
struct Motion {
  double at = 0.0;
  double rate = 0.0;

  Motion& operator+=(const Motion& other) {
    at += other.at;
    rate += other.rate;
    return *this;
  }
};

class Oscillator {
 public:
  Oscillator(double damping, double stiffness, double time) {
    const double half = 0.5 * damping;
    double square = half * half - stiffness;
    // Two equal roots are moved apart a little: by the root of rounding, of which the square is felt.
    const double least = 1e-10 * (half * half + 1.0 / (time * time));
    if (std::abs(square) < least) square = -least;
    if (square < 0.0) {
      first_ = {-half, std::sqrt(-square)};
      second_ = {-half, -first_.im};
    } else {
      const double fast = half + std::sqrt(square);
      first_ = {-stiffness / fast, 0.0};
      second_ = {-fast, 0.0};
    }
  }

  /// Started at q = at, q̇ = rate.
  [[nodiscard]] Motion free(double at, double rate, double time) const {
    const Complex v{rate, 0.0};
    return combined((v - at * second_) * exp(time * first_), (v - at * first_) * exp(time * second_));
  }
  /// Started at rest under the load.
  [[nodiscard]] Motion forced(const History& load) const {
    return combined(load.past(first_), load.past(second_));
  }

 private:
  [[nodiscard]] Motion combined(Complex first, Complex second) const {
    const Complex apart = first_ - second_;
    return {((first - second) / apart).re, ((first_ * first - second_ * second) / apart).re};
  }

  Complex first_, second_;  ///< roots
};

/// A load with its shapes: of the modes, and at rest.
struct ShapedLoad {
  enum class Place { everywhere, left, right } place;
  Load load;
};

class Bar {
 public:
  Bar(const Scene& scene, const Loads& loads, double fineness)
      : scene_(scene),
        length_(scene.body.length),
        density_(scene.material.density),
        modulus_(scene.material.youngs_modulus),
        viscosity_(loads.viscosity),
        damping_(loads.damping_rate),
        fineness_(fineness),
        left_fixed_(scene.ends.left == End::fixed),
        right_fixed_(scene.ends.right == End::fixed),
        offset_(left_fixed_ == right_fixed_ ? 0.0 : 0.5) {
    for (const Load& load : loads.gravity)
      loads_.push_back({ShapedLoad::Place::everywhere, {load.value * density_, load.amplitude}});
    if (!left_fixed_)
      for (const Load& load : loads.left) loads_.push_back({ShapedLoad::Place::left, load});
    if (!right_fixed_)
      for (const Load& load : loads.right) loads_.push_back({ShapedLoad::Place::right, load});
  }

  /// How many modes the fields at `time` ask for.
  [[nodiscard]] double modes_at(double time) const {
    // Beyond, a kink of the start is gone to rounding …
    double wave_number = std::sqrt(72.0 * density_ / (viscosity_ * time));
    // … and inertia plays no part in what changes at this rate.
    double rate = 0.0;
    const double relaxation = modulus_ / viscosity_;
    if (relaxation * time < 40.0) rate = relaxation;
    for (const ShapedLoad& each : loads_) {
      const Amplitude& amplitude = each.load.amplitude;
      rate = std::max(rate, 2.0 * numerics::pi * amplitude.frequency);
      if (amplitude.ramp_time > 0.0) rate = std::max(rate, 10.0 / amplitude.ramp_time);
    }
    wave_number = std::max(wave_number, 12.0 * rate * std::sqrt(density_ / modulus_));
    double least = 128.0;
    for (const auto& field : {scene_.initial_velocity, scene_.initial_displacement})
      if (field) least = std::max(least, 4.0 * field->mode);
    return least + length_ / numerics::pi * wave_number;
  }
  static constexpr double most_modes = 20000.0;

  ReferenceFields at(double time, std::span<const double> X) {
    if (time != time_) prepare(time);
    ReferenceFields fields;
    for (const double x : X) {
      double u = resting_.at;
      double v = resting_.rate;
      double stress = 0.0;
      double stretch = 1.0;
      for (std::size_t i = 0; i < loads_.size(); ++i) {
        const auto [shape, slope] = at_rest(loads_[i], x);
        stretch += slope * relaxed_[i].at;
        u += shape * relaxed_[i].at;
        v += shape * relaxed_[i].rate;
        stress += slope * histories_[i].now;
      }
      if (scene_.initial_displacement) {
        const double start = scene_.initial_displacement->at(x / length_, length_);
        u += start * remembered_;
        v -= start * remembered_ * modulus_ / viscosity_;
        stretch += scene_.initial_displacement->slope_at(x / length_, length_) * remembered_;
      }
      const double turn = x / length_;
      const Complex step{numerics::cos_pi(turn), numerics::sin_pi(turn)};
      const double first = (1.0 - offset_) * turn;
      Complex wave{numerics::cos_pi(first), numerics::sin_pi(first)};
      for (const Mode& mode : modes_) {
        const double shape = left_fixed_ ? wave.im : wave.re;
        u += mode.displacement * shape;
        v += mode.velocity * shape;
        const double slope = left_fixed_ ? wave.re : -wave.im;
        stress += mode.stress * slope;
        stretch += mode.strain * slope;
        wave = wave * step;
      }
      fields.displacement.push_back(u);
      fields.velocity.push_back(v);
      fields.stress.push_back(stress);
      fields.stretch.push_back(stretch);
    }
    return fields;
  }

 private:
  struct Mode {
    double displacement, velocity, stress, strain;
  };
  struct Shape {
    double displacement;  ///< of a body with E = 1 Pa
    double slope;
  };

  /// The static shape under the whole load, of a free body as it accelerates.
  [[nodiscard]] Shape at_rest(const ShapedLoad& each, double x) const {
    const double p = each.load.value;
    const double L = length_;
    const bool free = !left_fixed_ && !right_fixed_;
    switch (each.place) {
      case ShapedLoad::Place::left:
        return free ? Shape{p * (x - 0.5 * x * x / L - L / 3.0), p * (1.0 - x / L)} : Shape{p * (x - L), p};
      case ShapedLoad::Place::right:
        return free ? Shape{p * (0.5 * x * x / L - L / 6.0), p * x / L} : Shape{p * x, p};
      case ShapedLoad::Place::everywhere: break;
    }
    if (free) return {0.0, 0.0};
    if (left_fixed_ && right_fixed_) return {0.5 * p * x * (L - x), p * (0.5 * L - x)};
    return left_fixed_ ? Shape{p * x * (L - 0.5 * x), p * (L - x)} : Shape{0.5 * p * (L * L - x * x), -p * x};
  }

  /// ∫ shape · load dX of mode k = 1, 2, …; `sign` is that of cos kπ.
  [[nodiscard]] double force(const ShapedLoad& each, double wave_number, double sign) const {
    const double p = each.load.value;
    const bool mixed = left_fixed_ != right_fixed_;
    switch (each.place) {
      case ShapedLoad::Place::left: return -p;
      case ShapedLoad::Place::right: return mixed ? -sign * p : sign * p;
      case ShapedLoad::Place::everywhere: break;
    }
    if (mixed) return (left_fixed_ ? p : -sign * p) / wave_number;
    return left_fixed_ ? p * (1.0 - sign) / wave_number : 0.0;
  }

  /// 2/L ∫ shape · field dX of the mode `number` (k or k − 1/2).
  [[nodiscard]] double projected(const std::optional<InitialField>& field, double number, double sign) const {
    if (!field) return 0.0;
    const double kappa = number * numerics::pi;  // times length
    const bool mixed = left_fixed_ != right_fixed_;
    const double sine = mixed ? -sign : 0.0;  // at the right end
    const double cosine = mixed ? 0.0 : sign;
    if (field->shape == "sine") {
      const double m = field->mode;
      if (left_fixed_ && right_fixed_) return number == m ? field->amplitude : 0.0;
      const double turn = field->mode % 2 == 0 ? 1.0 : -1.0;  // cos mπ; sin mπ is 0
      // sin: ∫ sin κX sin μX, cos: ∫ cos κX sin μX, both by the sums of their arguments
      if (left_fixed_)
        return 2.0 * field->amplitude * turn * sine * m / ((number * number - m * m) * numerics::pi);
      if (number == m) return 0.0;
      return 2.0 * field->amplitude * m * (1.0 - turn * cosine) / ((m * m - number * number) * numerics::pi);
    }
    const double rise = field->gradient.value_or(0.0) * length_;
    if (left_fixed_)
      return 2.0 * (field->amplitude * (1.0 - cosine) / kappa + rise * (sine / kappa - cosine) / kappa);
    return 2.0 * (field->amplitude * sine / kappa + rise * (sine + (cosine - 1.0) / kappa) / kappa);
  }

  /// Mean over the body.
  [[nodiscard]] double mean(const std::optional<InitialField>& field) const {
    if (!field) return 0.0;
    if (field->shape == "sine")
      return field->mode % 2 == 0 ? 0.0 : 2.0 * field->amplitude / (numerics::pi * field->mode);
    return field->amplitude + 0.5 * field->gradient.value_or(0.0) * length_;
  }

  void prepare(double time) {
    time_ = time;
    histories_.clear();
    relaxed_.clear();
    const double relaxation = modulus_ / viscosity_;
    for (const ShapedLoad& each : loads_) {
      histories_.emplace_back(each.load.amplitude, time);
      const double at = histories_.back().past({-relaxation, 0.0}).re / viscosity_;
      relaxed_.push_back({at, (histories_.back().now - modulus_ * at) / viscosity_});
    }
    remembered_ = exp(Complex{-relaxation * time, 0.0}).re;
    resting_ = {};
    if (!left_fixed_ && !right_fixed_) {  // the body as a whole
      const Oscillator whole(damping_, 0.0, time);
      const double start = mean(scene_.initial_displacement);
      resting_ = whole.free(start, mean(scene_.initial_velocity), time);
      for (std::size_t i = 0; i < loads_.size(); ++i) {
        const ShapedLoad& each = loads_[i];
        const double sign = each.place == ShapedLoad::Place::left ? -1.0 : 1.0;
        const double over = each.place == ShapedLoad::Place::everywhere ? density_ : density_ * length_;
        const Motion motion = whole.forced(histories_[i]);
        const double factor = sign * each.load.value / over;
        resting_ += {factor * motion.at, factor * motion.rate};
      }
      resting_.at -= start * remembered_;
      resting_.rate += start * remembered_ * relaxation;
    }
    const double count = fineness_ * std::min(modes_at(time), most_modes);
    modes_.clear();
    for (int k = 1; k <= count; ++k) modes_.push_back(mode(k, time));
  }

  [[nodiscard]] Mode mode(double k, double time) const {
    const double sign = modes_.size() % 2 == 1 ? 1.0 : -1.0;  // cos kπ
    const double number = k - offset_;
    const double wave_number = number * numerics::pi / length_;
    const double square = wave_number * wave_number / density_;
    const Oscillator oscillator(damping_ + viscosity_ * square, modulus_ * square, time);
    const double start = projected(scene_.initial_displacement, number, sign);
    Motion q;
    const double rate = projected(scene_.initial_velocity, number, sign);
    if (start != 0.0 || rate != 0.0) q = oscillator.free(start, rate, time);
    double load = 0.0;  // of the present, over the wave number
    Motion without_inertia{start * remembered_, -start * remembered_ * modulus_ / viscosity_};
    for (std::size_t i = 0; i < loads_.size(); ++i) {
      const double factor = 2.0 * force(loads_[i], wave_number, sign) / (density_ * length_);
      if (factor == 0.0) continue;
      const Motion answer = oscillator.forced(histories_[i]);
      q += {factor * answer.at, factor * answer.rate};
      without_inertia += {factor / square * relaxed_[i].at, factor / square * relaxed_[i].rate};
      load += factor / square * histories_[i].now;
    }
    return {q.at - without_inertia.at, q.rate - without_inertia.rate,
            wave_number * (modulus_ * q.at + viscosity_ * q.rate - load),
            wave_number * (q.at - without_inertia.at)};
  }

  Scene scene_;
  double length_, density_, modulus_, viscosity_, damping_, fineness_;
  bool left_fixed_, right_fixed_;
  double offset_;  ///< mode k has k − offset half waves
  std::vector<ShapedLoad> loads_;
  double time_ = -1.0;
  std::vector<History> histories_;
  std::vector<Motion> relaxed_;  ///< of spring and dashpot under each load, with E = 1 Pa as its shape
  double remembered_ = 1.0;      ///< what spring and dashpot keep of a displacement at the start
  Motion resting_;               ///< of a free body as a whole
  std::vector<Mode> modes_;      ///< less what is summed up in the shapes at rest
};

}  // namespace

std::optional<FieldsAt> kelvin_voigt_bar(const Scene& scene, const Loads& loads, double fineness) {
  const auto bar = std::make_shared<Bar>(scene, loads, fineness);
  if (bar->modes_at(scene.end_time) > Bar::most_modes) return std::nullopt;
  for (const auto* some : {&loads.gravity, &loads.left, &loads.right})
    for (const Load& load : *some)
      if (load.amplitude.duration > 0.0 && load.amplitude.duration < 2.0 * load.amplitude.ramp_time)
        return std::nullopt;
  return [bar, scene, viscosity = loads.viscosity](double time, std::span<const double> X) {
    if (time > 0.0) return bar->at(time, X);
    ReferenceFields fields;
    const double length = scene.body.length;
    const auto& u = scene.initial_displacement;
    const auto& v = scene.initial_velocity;
    for (const double x : X) {
      fields.displacement.push_back(u ? u->at(x / length, length) : 0.0);
      fields.velocity.push_back(v ? v->at(x / length, length) : 0.0);
      const double strain = u ? u->slope_at(x / length, length) : 0.0;
      fields.stress.push_back(scene.material.youngs_modulus * strain +
                              (v ? viscosity * v->slope_at(x / length, length) : 0.0));
      fields.stretch.push_back(1.0 + strain);
    }
    return fields;
  };
}

}  // namespace hompm
