#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <hompm/kit/verify/foreign_matching.hpp>
#include <hompm/number.hpp>

namespace hompm::detail {
namespace {

/// A value of A and the one it should be, at all times.
struct Sample {
  double time, X, a, b, velocity;  ///< the velocity is that of B, NaN where it is not known
};
using Samples = std::vector<Sample>;

double largest(const Samples& samples, auto value) {
  double size = 0.0;
  for (const Sample& s : samples) size = std::max(size, std::abs(value(s)));  // passes over NaN
  return size;
}

/// The factor c of the least squares of `value` − c `shape`, and what is left over of the largest value.
struct Fit {
  double factor = 0.0;
  double left = 1.0;
};
Fit fit(const Samples& samples, auto value, auto shape) {
  double product = 0.0;
  double square = 0.0;
  for (const Sample& s : samples) {
    const double term = value(s) * shape(s);
    if (std::isnan(term)) continue;
    product += term;
    square += shape(s) * shape(s);
  }
  const double size = largest(samples, value);
  if (square == 0.0 || size == 0.0) return {};
  const double c = product / square;
  return {c, largest(samples, [&](const Sample& s) { return value(s) - c * shape(s); }) / size};
}

/// Values by field; where no particle of A has one in B: in order, or against the exact solution.
std::map<std::string, Samples> samples_of(const ForeignComparison& found) {
  std::map<std::string, Samples> all;
  for (const auto& curves : found.curves) {
    const auto velocity = std::ranges::find_if(found.curves, [&](const auto& other) {
      return other.field == "velocity" && other.time == curves.time;
    });
    auto pairs = curves.pairs;
    const bool exact = pairs.empty() && curves.X_a.size() != curves.X_b.size();
    if (pairs.empty() && !(exact && curves.exact_a.empty()))
      for (std::size_t p = 0; p < curves.X_a.size(); ++p) pairs.emplace_back(p, p);
    for (const auto& [i, j] : pairs) {
      const auto& b = exact ? curves.exact_a : curves.b;
      double v = std::nan("");
      if (velocity != found.curves.end()) {
        const auto& values = exact ? velocity->exact_a : velocity->b;
        if (j < values.size()) v = values[j];
      }
      all[curves.field].push_back({curves.time, curves.X_a[i], curves.a[i], b[j], v});
    }
  }
  return all;
}

struct Factor {
  std::vector<std::string> fields;
  double factor;
  std::string meaning;
};

const std::vector<Factor>& known_factors() {
  const std::vector<std::string> lengths{"X", "x", "displacement", "volume"};
  static const std::vector<Factor> all{{lengths, 1e3, "millimetres?"},
                                       {lengths, 1e2, "centimetres?"},
                                       {lengths, 1e6, "micrometres?"},
                                       {lengths, 1e-3, "kilometres?"},
                                       {{"time"}, 1e3, "milliseconds?"},
                                       {{"time"}, 1e6, "microseconds?"},
                                       {{"velocity"}, 1e3, "mm/s?"},
                                       {{"velocity"}, 1e2, "cm/s?"},
                                       {{"velocity"}, 1e-3, "km/s, or mm/µs?"},
                                       {{"stress"}, 1e-3, "kPa?"},
                                       {{"stress"}, 1e-6, "MPa?"},
                                       {{"stress"}, 1e-9, "GPa?"},
                                       {{"stress"}, -1.0, "compression positive?"},
                                       {{"stress"}, -1e-3, "kPa, compression positive?"},
                                       {{"stress"}, -1e-6, "MPa, compression positive?"},
                                       {{"density"}, 1e-3, "g/cm³?"},
                                       {{"density"}, 1e-12, "t/mm³?"},
                                       {{"displacement", "velocity"}, -1.0, "the axis the other way round?"}};
  return all;
}

/// "X: A is 1000 × B: millimetres?", or "".
std::string factor_hint(const std::string& field, double ratio) {
  for (const auto& known : known_factors()) {
    if (std::ranges::find(known.fields, field) == known.fields.end()) continue;
    if (std::abs(ratio / known.factor - 1.0) > 0.03) continue;
    return field + ": A is " + (known.factor < 0.0 ? "−" : "") + to_text(std::abs(known.factor)) +
           " × B: " + known.meaning;
  }
  return "";
}

std::string three_digits(double value) {
  std::array<char, 32> text{};
  return {text.begin(), std::to_chars(text.begin(), text.end(), value, std::chars_format::general, 3).ptr};
}

std::string steps(double seconds, const std::optional<Scene>& scene) {
  const double step = scene && scene->scheme.time_step ? *scene->scheme.time_step : 0.0;
  const double count = step > 0.0 ? std::abs(seconds) / step : 0.0;
  if (std::abs(count - 1.0) < 0.15) return "one step, " + to_text(step) + " s";
  if (std::abs(count - 0.5) < 0.1) return "half a step, " + to_text(0.5 * step) + " s";
  return three_digits(std::abs(seconds)) + " s";
}

/// ∂v/∂t of the exact solution, by place in `samples`; empty where it is not known.
std::vector<double> accelerations(const Samples& samples, const Scene& scene) {
  std::vector<double> all;
  std::string reason;
  const auto reference = make_reference(scene);
  const double h = 1e-4 * scene.end_time;
  for (std::size_t begin = 0; reference && begin < samples.size(); begin = all.size()) {
    std::vector<double> X;
    const double time = samples[begin].time;
    for (std::size_t i = begin; i < samples.size() && samples[i].time == time; ++i) X.push_back(samples[i].X);
    const double from = std::max(0.0, time - h);
    const auto before = sound_fields(*reference, from, X, reason);
    const auto after = before ? sound_fields(*reference, time + h, X, reason) : before;
    if (!after) return {};
    for (std::size_t i = 0; i < X.size(); ++i)
      all.push_back((after->velocity[i] - before->velocity[i]) / (time + h - from));
  }
  return all;
}

/// Whether single precision, or nine digits, hold the value.
bool is_single(double value) {
  if (static_cast<double>(static_cast<float>(value)) == value) return true;
  const std::string text = to_text(value);
  const std::string digits = text.substr(0, text.find('e'));
  const auto first = digits.find_first_of("123456789");
  return std::count_if(digits.begin() + static_cast<std::ptrdiff_t>(first), digits.end(),
                       [](char c) { return c != '.'; }) <= 9;
}

std::string precision_hint(const std::map<std::string, Samples>& samples) {
  std::size_t count = 0;
  bool theirs = true;
  for (const auto& [field, all] : samples) {
    for (const Sample& s : all) {
      if (s.a == 0.0 || std::isnan(s.a)) continue;
      if (!is_single(s.a)) return "";
      theirs = theirs && (s.b == 0.0 || is_single(s.b));
      ++count;
    }
  }
  if (count < 4 || theirs) return "";
  return "all values of A fit in single precision: no bound below 6e-8 can hold; are they computed or "
         "written so?";
}

void count_hints(const ForeignComparison& found, const Scene& scene, std::vector<std::string>& hints) {
  const auto& curves = found.curves.front();
  const std::size_t mine = curves.X_a.size();
  const std::size_t theirs = curves.X_b.size();
  if (mine == theirs || mine == 0 || theirs == 0) return;
  if (!curves.pairs.empty() && curves.pairs.size() == mine && mine < theirs) {
    const std::size_t first = curves.pairs.front().second;
    const bool gap = curves.pairs.back().second - first + 1 != mine;
    if (gap || (first > 0 && curves.pairs.back().second + 1 < theirs)) return;
    hints.push_back("A lacks " + std::to_string(theirs - mine) + " of " + std::to_string(theirs) +
                    " particles, all at the " + (first > 0 ? "left" : "right") + " end");
    return;
  }
  if (scene.scheme.cells == 0 || !scene.bodies.empty()) return;
  const auto cells = static_cast<std::size_t>(scene.scheme.cells);
  const auto each = static_cast<std::size_t>(scene.scheme.particles_per_cell);
  std::string text = "A has " + std::to_string(mine) + " particles, B " + std::to_string(cells) +
                     " cells × " + std::to_string(each) + ": ";
  std::string guess;
  for (std::size_t p = 1; p <= 4; ++p)
    if (mine % p == 0)
      guess += (guess.empty() ? "" : ", ") + std::to_string(mine / p) + " × " + std::to_string(p);
  hints.push_back(text + (mine % cells == 0 ? std::to_string(mine / cells) + " in a cell" : guess) + "?");
}

}  // namespace

std::vector<std::string> mistakes(const ForeignComparison& found, const std::vector<double>& times_a,
                                  const std::vector<double>& times_b, const std::optional<Scene>& scene) {
  std::vector<std::string> hints;
  const auto add = [&](const std::string& hint) {
    if (!hint.empty()) hints.push_back(hint);
  };
  if (times_b.back() > 0.0) add(factor_hint("time", times_a.back() / times_b.back()));
  if (found.curves.empty()) return hints;

  // 1. Where the particles are.
  const auto& first = found.curves.front();
  if (first.pairs.empty() && !first.X_a.empty()) {
    const double mine = first.X_a.back() + first.X_a.front();  // twice the middle: the same on every grid
    double theirs = scene ? 2.0 * scene->body.left() + scene->body.length : 0.0;
    if (!first.X_b.empty()) theirs = first.X_b.back() + first.X_b.front();
    add(factor_hint("X", mine / theirs));
  }
  if (scene) count_hints(found, *scene, hints);

  // 2. Fields that fail: what explains nearly all of the difference?
  const auto samples = samples_of(found);
  std::map<std::string, double> factors;
  const auto difference = [](const Sample& s) { return s.a - s.b; };
  const auto fails = [&](const std::string& field) {
    return std::ranges::any_of(found.fields, [&](const auto& f) {
      return f.field == field && (f.beyond > 0 || f.beyond_exact || f.particles == 0);
    });
  };
  bool displacement_is_right = true;
  for (const auto& [field, all] : samples) {
    const double distance = largest(all, difference);
    if (!fails(field) || distance == 0.0) continue;
    const auto b = [](const Sample& s) { return s.b; };
    const Fit factor = fit(
        all, [](const Sample& s) { return s.a; }, b);
    const double left = factor.left * largest(all, [](const Sample& s) { return s.a; });
    if (left <= 0.1 * distance) {
      const std::string hint = factor_hint(field, factor.factor);
      if (hint.empty()) factors[field] = factor.factor;
      add(hint);
    }
    if (field == "displacement") {
      const auto from_x = [](const Sample& s) { return s.a - s.X - s.b; };
      displacement_is_right = distance < 1e-3 * largest(all, b);
      if (largest(all, from_x) <= 0.1 * distance) add("displacement of A is X + that of B: is it x?");
      const Fit shift = fit(all, difference, [](const Sample& s) { return s.velocity; });
      if (shift.left < 0.3 && std::abs(shift.factor) < 0.1 * times_b.back())
        add("A is " + steps(shift.factor, scene) + (shift.factor > 0.0 ? ", ahead" : ", behind") +
            ": are its times those of another step?");
    }
    if (field == "x" && largest(all, [](const Sample& s) { return s.a + s.X - s.b; }) <= 0.1 * distance)
      add("x of A is that of B without X: is it the displacement?");
    const double part = distance / largest(all, b);
    if (field == "velocity" && displacement_is_right && scene && scene->scheme.time_step && part > 1e-9 &&
        part < 0.1) {
      const auto rates = accelerations(all, *scene);
      double da = 0.0;
      double dd = 0.0;
      double aa = 0.0;
      for (std::size_t i = 0; i < rates.size(); ++i) {
        const double d = difference(all[i]);
        if (std::isnan(d)) continue;
        da += d * rates[i];
        dd += d * d;
        aa += rates[i] * rates[i];
      }
      const double half = 0.5 * *scene->scheme.time_step;
      if (std::abs(da) > 0.7 * std::sqrt(dd * aa) && std::abs(std::abs(da / aa) - half) < 0.4 * half)
        add("velocity of A is half a step " + std::string(da > 0.0 ? "ahead" : "behind") +
            ": is it at the time of the positions?");
    }
  }
  if (factors.size() > 1) {
    const double factor = factors.begin()->second;
    const bool same = std::ranges::all_of(
        factors, [&](const auto& f) { return std::abs(f.second - factor) < 0.1 * std::abs(factor - 1.0); });
    std::string names;
    for (const auto& [field, ignored] : factors) names += (names.empty() ? "" : ", ") + field;
    if (same) add(names + " of A are " + three_digits(factor) + " × those of B: another amplitude or load?");
  }
  add(precision_hint(samples));
  return hints;
}

}  // namespace hompm::detail
