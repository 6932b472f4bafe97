#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <hompm/number.hpp>
#include <hompm/numerics/elementary.hpp>
#include <hompm/reference/characteristics.hpp>

namespace hompm {
namespace {

/// Crossing of a rising and a falling curve; place and velocity as the falling observer sees them.
struct Crossing {
  double time = 0.0;
  double place = 0.0;      ///< y
  double reference = 0.0;  ///< X
  double velocity = 0.0;   ///< w
  double density = 0.0;    ///< 1/λ

  friend Crossing operator+(const Crossing& a, const Crossing& b) {
    return {a.time + b.time, a.place + b.place, a.reference + b.reference, a.velocity + b.velocity,
            a.density + b.density};
  }
  friend Crossing operator*(double factor, const Crossing& a) {
    return {factor * a.time, factor * a.place, factor * a.reference, factor * a.velocity, factor * a.density};
  }
};

/// The net at one resolution, row by row. Row i is the rising curve i from the base to the free end; its
/// crossing k is with the falling curve i − n + k, which is the rising curve of that number after its
/// reflection at the free end. Curve 0 carries the kink; back at the base it goes on as curve n, so that n
/// curves make a round trip.
class Net {
 public:
  Net(const GasColumn& column, std::size_t n)
      : c_(column.wave_speed), b_(column.acceleration), row_(n + 1), curves_(n + 1, Curve{0.0, 1.0, 1.0}) {
    for (std::size_t k = 0; k <= n; ++k) {  // the kink rises through material at rest
      const double X = column.length * static_cast<double>(k) / static_cast<double>(n);
      row_[k] = {X / c_, X, X, 0.0, 1.0};
    }
  }

  void advance() {
    const std::size_t n = row_.size() - 1;
    previous_.swap(row_);
    row_.resize(n + 1);
    row_[0] = base(previous_[1]);
    const std::size_t falling = curves_.size() - n;  // the falling curve that ends at the base
    const double invariant = 2.0 * row_[0].velocity - curves_[falling].invariant;
    const double factor = numerics::exp(0.5 * invariant / c_);
    curves_.push_back({invariant, factor, 1.0 / factor});
    row_[0].density = factor * curves_[falling].falling_factor;
    for (std::size_t k = 1; k <= n; ++k) {
      const Curve& other = curves_[falling + k];
      row_[k].velocity = 0.5 * (invariant + other.invariant);
      row_[k].density = factor * other.falling_factor;
      if (k < n) {
        meet(row_[k], row_[k - 1], previous_[k + 1], c_);
      } else {
        meet(row_[k], row_[k - 1], previous_[n], 0.0);  // the free end moves with the material
      }
    }
  }

  [[nodiscard]] const std::vector<Crossing>& row() const { return row_; }
  /// About the earliest time at which curves of one family met.
  [[nodiscard]] double shock_time() const { return shock_time_; }

 private:
  struct Curve {
    double invariant;  ///< w − c ln λ on the way up and, as λ = 1 at the free end, w + c ln λ on the way down
    double rising_factor;   ///< e^(invariant/2c): 1/λ at a crossing is the product of a rising …
    double falling_factor;  ///< … and a falling factor
  };

  /// Where the falling curve from `before` meets the base, whose place is y = −bt²/2 and whose velocity −bt.
  [[nodiscard]] Crossing base(const Crossing& before) const {
    const double slope = 0.5 * before.velocity - c_;
    const double time = (slope * before.time - before.place) / (slope + 0.5 * b_ * before.time);
    return {time, -0.5 * b_ * time * time, 0.0, -b_ * time, 0.0};
  }

  /// Where the rising curve from `below` meets the one from `before` that moves with the velocity w − speed.
  void meet(Crossing& at, const Crossing& below, const Crossing& before, double speed) {
    const double rise = 0.5 * (at.velocity + below.velocity) + c_;
    const double fall = 0.5 * (at.velocity + before.velocity) - speed;
    at.time = (before.place - below.place + rise * below.time - fall * before.time) / (rise - fall);
    at.place = below.place + rise * (at.time - below.time);
    at.reference = below.reference + 0.5 * c_ * (at.density + below.density) * (at.time - below.time);
    if (!(at.time > below.time && at.time > before.time)) {
      shock_time_ = std::min({shock_time_, below.time, before.time});
    }
  }

  double c_;
  double b_;
  std::vector<Crossing> row_;
  std::vector<Crossing> previous_;
  std::vector<Curve> curves_;  // −n, −n + 1, …; those below 0 fall from the start
  double shock_time_ = std::numeric_limits<double>::infinity();
};

/// Romberg's table: removes the error terms h², h⁴, h⁶ from values at h, h/2, h/4, h/8.
template <std::size_t levels>
Crossing extrapolated(std::array<Crossing, levels> value) {
  double factor = 1.0;
  for (std::size_t level = 1; level < levels; ++level) {
    factor *= 4.0;
    for (std::size_t i = 0; i + level < levels; ++i) {
      value[i] = (factor / (factor - 1.0)) * value[i + 1] + (-1.0 / (factor - 1.0)) * value[i];
    }
  }
  return value[0];
}

class Column {
 public:
  Column(const GasColumn& column, std::size_t n, ReferenceWatch watch)
      : column_(column),
        watch_(std::move(watch)),
        n_(n),
        nets_{Net(column, n), Net(column, 2 * n), Net(column, 4 * n), Net(column, 8 * n)} {
    store();
  }

  ReferenceFields at(double time, std::span<const double> X) {
    if (time < time_) throw Error("the reference solution cannot go back in time");
    time_ = time;
    extend(time);
    // Row by row up the base to the first curve that starts later.
    Labels labels{0.0, 0.0};
    for (std::size_t i = 0; rows_[i].front().time < time; ++i) labels.rising += 1.0;
    labels.falling = labels.rising - static_cast<double>(n_);

    const double c = column_.wave_speed;
    const double b = column_.acceleration;
    ReferenceFields fields;
    for (const double x : X) {
      Crossing found{time, x, x, 0.0, 1.0};  // not yet reached by the kink
      if (x < c * time) found = find(time, x, labels);
      fields.displacement.push_back(found.place - x + 0.5 * b * time * time);
      fields.velocity.push_back(found.velocity + b * time);
      fields.stress.push_back(column_.density * c * c * (1.0 - found.density));
      fields.stretch.push_back(1.0 / found.density);
    }
    return fields;
  }

  /// Where the kink is: on a rising curve of a number that is a multiple of n, then on the falling one.
  double kink(double time) {
    if (time == 0.0) return 0.0;
    extend(time);
    std::size_t start = 0;
    while (start + n_ + 1 < rows_.size() && rows_[start + n_].front().time <= time) start += n_;
    const double curve = static_cast<double>(start);
    const bool rises = time <= rows_[start].back().time;
    double low = rises ? curve - static_cast<double>(n_) : curve;
    double high = low + static_cast<double>(n_);
    Crossing found;
    for (double other = 0.5 * (low + high); low < other && other < high; other = 0.5 * (low + high)) {
      refine(time, 0.0, rises ? Labels{curve, other} : Labels{other, curve}, found);
      (found.time < time ? low : high) = other;
    }
    return found.reference;
  }

 private:
  /// Numbers of the two curves through a point, as real numbers: falling ≤ rising ≤ falling + n.
  struct Labels {
    double rising;
    double falling;
  };
  static constexpr std::size_t degree = 7;  // of the interpolation within the coarsest net

  /// Lays the nets up to `time`, by whole round trips.
  void extend(double time) {
    for (;;) {
      const double shock = nets_.back().shock_time();
      if (time >= shock) {
        throw Error("no smooth reference solution exists beyond t = " + to_text(shock) + " s: a shock forms");
      }
      if (rows_.size() % n_ == 1 && rows_.back().front().time >= time) return;
      if (watch_) watch_(rows_.back().front().time / time);
      for (std::size_t level = 0; level < nets_.size(); ++level) {
        for (std::size_t i = 0; i < std::size_t{1} << level; ++i) nets_[level].advance();
      }
      store();
    }
  }

  void store() {
    std::vector<Crossing>& row = rows_.emplace_back();
    for (std::size_t k = 0; k <= n_; ++k) {
      row.push_back(extrapolated<4>(
          {nets_[0].row()[k], nets_[1].row()[2 * k], nets_[2].row()[4 * k], nets_[3].row()[8 * k]}));
    }
  }

  /// The crossing at (time, X), by Newton's method on the labels from those given, which it replaces.
  Crossing find(double time, double X, Labels& labels) const {
    const double n = static_cast<double>(n_);
    const double last = static_cast<double>(rows_.size() - 1);
    Crossing found;
    for (int iteration = 0; iteration < 60; ++iteration) {
      labels.rising = std::clamp(labels.rising, 0.0, last);
      labels.falling = std::clamp(labels.falling, labels.rising - n, labels.rising);
      const Labels step = refine(time, X, labels, found);
      labels.rising += step.rising;
      labels.falling += step.falling;
      if (std::abs(step.rising) + std::abs(step.falling) < 1e-12) break;
    }
    return found;
  }

  Labels refine(double time, double X, const Labels& labels, Crossing& found) const;

  GasColumn column_;
  ReferenceWatch watch_;
  std::size_t n_;
  std::array<Net, 4> nets_;
  std::vector<std::vector<Crossing>> rows_;  // of the coarsest net, extrapolated
  double time_ = 0.0;
};

/// Interpolates between the crossings around the labels, never across a kink, and returns the step towards
/// (time, X).
Column::Labels Column::refine(double time, double X, const Labels& labels, Crossing& found) const {
  // Kinks (labels that are multiples of n) and boundaries cut the strip of labels into triangles, those at
  // the free end with falling ≤ rising, those at the base with falling ≥ rising, both counted from the
  // triangle's corner.
  const double n = static_cast<double>(n_);
  const std::size_t whole_trips = (rows_.size() - 1) / n_;
  const double last_trip = static_cast<double>(whole_trips - 1);
  const double rising_trip = std::min(std::floor(labels.rising / n), last_trip);
  const bool upper = labels.falling >= rising_trip * n;
  const double rising = labels.rising - rising_trip * n;
  const double falling = labels.falling - (upper ? rising_trip : rising_trip - 1.0) * n;
  // Within, a smaller triangle of the same shape carries the polynomial.
  const double d = static_cast<double>(degree);
  const double greater = upper ? rising : falling;
  const double lesser = upper ? falling : rising;
  const double low = std::clamp(std::floor(lesser - d / 3.0 + 0.5), 0.0, n - d);
  const double high = std::clamp(std::floor(greater - 2.0 * d / 3.0 + 0.5), low, n - d);

  // Silvester's polynomials: at distance s from a side, in steps, the factor s(s−1)…(s−a+1)/a! is 1 on the
  // parallel a.
  const auto factors = [](double s) {
    std::array<double, degree + 1> factor{1.0};
    for (std::size_t a = 1; a <= degree; ++a)
      factor[a] = factor[a - 1] * (s - static_cast<double>(a - 1)) / static_cast<double>(a);
    return factor;
  };
  const auto from_greatest = factors(high + d - greater);
  const auto from_lowest = factors(lesser - low);
  const auto from_diagonal = factors((greater - high) - (lesser - low));
  const auto node = [&](std::size_t up, std::size_t right) -> const Crossing& {
    const std::size_t g = static_cast<std::size_t>(high) + right;
    const std::size_t l = static_cast<std::size_t>(low) + up;
    const std::size_t i = (upper ? g : l) + static_cast<std::size_t>(rising_trip) * n_;
    return rows_[i][upper ? n_ + l - g : g - l];
  };
  found = {};
  for (std::size_t right = 0; right <= degree; ++right) {
    for (std::size_t up = 0; up <= right; ++up) {
      found = found +
              (from_greatest[degree - right] * from_lowest[up] * from_diagonal[right - up]) * node(up, right);
    }
  }

  // The slopes between the corners of the triangle are near enough for Newton's method.
  const Crossing greater_slope = (1.0 / d) * (node(0, degree) + -1.0 * node(0, 0));
  const Crossing lesser_slope = (1.0 / d) * (node(degree, degree) + -1.0 * node(0, degree));
  const double determinant =
      greater_slope.time * lesser_slope.reference - lesser_slope.time * greater_slope.reference;
  const double late = time - found.time;
  const double far = X - found.reference;
  const double greater_step = (late * lesser_slope.reference - far * lesser_slope.time) / determinant;
  const double lesser_step = (far * greater_slope.time - late * greater_slope.reference) / determinant;
  return upper ? Labels{greater_step, lesser_step} : Labels{lesser_step, greater_step};
}

}  // namespace

GasColumnSolution gas_column(const GasColumn& column, int curves, const ReferenceWatch& watch) {
  auto solution = std::make_shared<Column>(column, static_cast<std::size_t>(curves), watch);
  return {[solution](double time, std::span<const double> X) { return solution->at(time, X); },
          [solution](double time) { return solution->kink(time); }};
}

}  // namespace hompm
