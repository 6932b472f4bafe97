#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <hompm/kit/verify/foreign_matching.hpp>
#include <hompm/number.hpp>

namespace hompm::detail {
namespace {

std::string list(std::span<const double> times) {
  std::string text;
  for (const double time : times) text += (text.empty() ? "" : ", ") + to_text(time);
  return text;
}

/// The times around `time`, two on either side as far as they are there.
std::vector<double> around(const std::vector<double>& times, double time) {
  const auto above = std::lower_bound(times.begin(), times.end(), time);
  const auto first = above - std::min<std::ptrdiff_t>(2, above - times.begin());
  const auto last = above + std::min<std::ptrdiff_t>(2, times.end() - above);
  return {first, last};
}

}  // namespace

std::vector<TimeMatch> match_times(ParticleTable& a, std::span<const double> wanted, double tolerance,
                                   bool interpolate) {
  std::vector<TimeMatch> matches;
  const auto& times = a.times();
  for (const double time : wanted) {
    const auto near =
        std::ranges::min_element(times, {}, [&](double other) { return std::abs(other - time); });
    if (std::abs(*near - time) <= tolerance) {
      if (*near != time) a.note("time " + to_text(*near) + " is taken for " + to_text(time));
      matches.push_back({time, {*near}});
    } else if (time == wanted.back() && !matches.empty() && times.back() < time &&
               times.back() > 0.99 * time) {
      a.note("time " + to_text(time) + " is not compared: A ends before it, at " + to_text(times.back()) +
             "; --time-tolerance takes the one for the other");
    } else if (time < times.front() || time > times.back()) {
      a.fault("missing times", "time " + to_text(time) + " is missing: the file goes from " +
                                   to_text(times.front()) + " to " + to_text(times.back()) +
                                   "; --time compares only times that are named");
    } else if (!interpolate) {
      const auto above = std::ranges::lower_bound(times, time);
      a.fault("missing times", "time " + to_text(time) + " is missing, the next ones are " +
                                   to_text(*(above - 1)) + " and " + to_text(*above) +
                                   "; --interpolate computes it from those around it, --time compares only "
                                   "times that are named");
    } else {
      matches.push_back({time, around(times, time)});
      a.note("time " + to_text(time) + " is interpolated between " + list(matches.back().sources));
    }
  }
  return matches;
}

ParticleBlock block_at(ParticleTable& a, const TimeMatch& match, std::span<const ParticleBlock> blocks) {
  ParticleBlock result = blocks.front();
  result.time = match.time;
  if (blocks.size() == 1) return result;
  for (const auto& block : blocks) {
    if (block.X == result.X) continue;
    a.fault("changing particles",
            "time " + to_text(match.time) + " cannot be interpolated: the particles at times " +
                to_text(blocks.front().time) + " and " + to_text(block.time) + " are not the same");
    return {match.time, {}, {}, std::vector<std::vector<double>>(result.values.size())};
  }
  for (auto& values : result.values) std::fill(values.begin(), values.end(), 0.0);
  for (std::size_t j = 0; j < blocks.size(); ++j) {
    double weight = 1.0;  // Lagrange's
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      if (k != j) weight *= (match.time - blocks[k].time) / (blocks[j].time - blocks[k].time);
    }
    for (std::size_t f = 0; f < result.values.size(); ++f) {
      for (std::size_t p = 0; p < result.X.size(); ++p) {
        result.values[f][p] += weight * blocks[j].values[f][p];
      }
    }
  }
  return result;
}

Pairs match_particles(ParticleTable& a, const ParticleBlock& mine, const ParticleBlock& golden, double cell,
                      bool needed) {
  const bool by_body = !mine.body.empty() && !golden.body.empty();
  const auto key = [&](const ParticleBlock& block, std::size_t i) {
    return std::pair(by_body ? block.body[i] : 0, block.X[i]);
  };
  const auto order_of = [&](const ParticleBlock& block) {
    std::vector<std::size_t> order(block.X.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return key(block, i); });
    return order;
  };
  const auto order_a = order_of(mine);
  const auto order_b = order_of(golden);
  double distance = std::numeric_limits<double>::infinity();
  for (std::size_t p = 1; p < order_b.size(); ++p) {
    const auto [body_before, before] = key(golden, order_b[p - 1]);
    const auto [body, X] = key(golden, order_b[p]);
    if (body == body_before) distance = std::min(distance, X - before);
  }
  const bool overlap = !by_body && distance == 0.0;
  if (std::isinf(distance)) distance = cell;
  double tolerance = 1e-3 * distance;
  for (const double X : golden.X) tolerance = std::max(tolerance, 1e-12 * std::abs(X));  // rounding

  Pairs pairs;
  std::vector<double> missing;
  std::vector<double> extra;
  double furthest = 0.0;
  for (std::size_t i = 0, j = 0; i < order_a.size() || j < order_b.size();) {
    const bool has_a = i < order_a.size();
    const bool has_b = j < order_b.size();
    const auto [body_a, x] = has_a ? key(mine, order_a[i]) : key(golden, order_b[j]);
    const auto [body_b, y] = has_b ? key(golden, order_b[j]) : key(mine, order_a[i]);
    if (has_a && has_b && body_a == body_b && std::abs(x - y) <= tolerance) {
      furthest = std::max(furthest, std::abs(x - y));
      pairs.emplace_back(order_a[i++], order_b[j++]);
    } else if (!has_b || (has_a && std::pair(body_a, x) < std::pair(body_b, y))) {
      extra.push_back(x);
      ++i;
    } else {
      missing.push_back(y);
      ++j;
    }
  }
  const auto say = [&](const std::string& kind, const std::string& text) {
    needed ? a.fault(kind, text) : a.note(kind, text);
  };
  const std::string when = " at time " + to_text(golden.time);
  if (pairs.empty()) {
    say("unmatched particles", "none of the " + std::to_string(mine.X.size()) + " particles" + when +
                                   " has the X of one of the " + std::to_string(golden.X.size()) +
                                   " of B: only the exact solution can be compared with");
    return pairs;
  }
  if (overlap)
    say("overlapping bodies", "bodies of B overlap" + when + ": a column `body` has to tell which is which");
  for (const double X : missing)
    say("missing particles", "the particle at X = " + to_text(X) + " is missing" + when);
  for (const double X : extra) say("extra particles", "B has no particle at X = " + to_text(X) + when);
  if (furthest > 0.0) a.note("particles are matched by X to within " + to_text(furthest) + " m" + when);
  return pairs;
}

}  // namespace hompm::detail
