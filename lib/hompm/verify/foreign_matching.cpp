#include <algorithm>
#include <cmath>
#include <limits>

#include <hompm/number.hpp>
#include <hompm/verify/foreign_matching.hpp>

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

std::vector<TimeMatch> match_times(ForeignTable& a, std::span<const double> wanted, double last,
                                   bool interpolate) {
  std::vector<TimeMatch> matches;
  const auto& times = a.times();
  for (const double time : wanted) {
    const auto near = std::min_element(times.begin(), times.end(), [&](double s, double t) {
      return std::abs(s - time) < std::abs(t - time);
    });
    if (std::abs(*near - time) <= 1e-9 * last) {
      if (*near != time) a.note("time " + to_text(*near) + " is taken for " + to_text(time));
      matches.push_back({time, {*near}});
    } else if (time < times.front() || time > times.back()) {
      a.fault("missing times", "time " + to_text(time) + " is missing: the file goes from " +
                                   to_text(times.front()) + " to " + to_text(times.back()) +
                                   "; --time compares only times that are named");
    } else if (!interpolate) {
      const auto above = std::lower_bound(times.begin(), times.end(), time);
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

ParticleBlock block_at(ForeignTable& a, const TimeMatch& match, std::span<const ParticleBlock> blocks) {
  ParticleBlock result = blocks.front();
  result.time = match.time;
  if (blocks.size() == 1) return result;
  for (const auto& block : blocks) {
    if (block.X == result.X) continue;
    a.fault("changing particles",
            "time " + to_text(match.time) + " cannot be interpolated: the particles at times " +
                to_text(blocks.front().time) + " and " + to_text(block.time) + " are not the same");
    return {match.time, {}, std::vector<std::vector<double>>(result.values.size())};
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

std::vector<std::pair<std::size_t, std::size_t>> match_particles(ForeignTable& a, const ParticleBlock& mine,
                                                                 const ParticleBlock& golden) {
  double tolerance = std::numeric_limits<double>::infinity();
  for (std::size_t p = 1; p < golden.X.size(); ++p) {
    tolerance = std::min(tolerance, 1e-3 * (golden.X[p] - golden.X[p - 1]));
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::vector<double> missing;
  std::vector<double> extra;
  double furthest = 0.0;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < mine.X.size() || j < golden.X.size()) {
    const double x = i < mine.X.size() ? mine.X[i] : std::numeric_limits<double>::infinity();
    const double y = j < golden.X.size() ? golden.X[j] : std::numeric_limits<double>::infinity();
    if (std::abs(x - y) <= tolerance) {
      furthest = std::max(furthest, std::abs(x - y));
      pairs.emplace_back(i++, j++);
    } else if (x < y) {
      extra.push_back(x);
      ++i;
    } else {
      missing.push_back(y);
      ++j;
    }
  }
  const std::string when = " at time " + to_text(golden.time);
  if (pairs.empty()) {
    a.fault("unmatched particles", "none of the " + std::to_string(mine.X.size()) + " particles" + when +
                                       " has the X of one of the " + std::to_string(golden.X.size()) +
                                       " of B: only the exact solution can be compared with");
    return pairs;
  }
  for (const double X : missing) {
    a.fault("missing particles", "the particle at X = " + to_text(X) + " is missing" + when);
  }
  for (const double X : extra) {
    a.fault("extra particles", "B has no particle at X = " + to_text(X) + when);
  }
  if (furthest > 0.0) a.note("particles are matched by X to within " + to_text(furthest) + " m" + when);
  return pairs;
}

}  // namespace hompm::detail
