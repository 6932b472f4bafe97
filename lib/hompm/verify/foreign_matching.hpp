// Which rows of another code's results belong to which of a golden folder.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hompm/verify/foreign_table.hpp>

namespace hompm::detail {

/// A time of B and how to get it from A.
struct TimeMatch {
  double time = 0.0;            ///< in B, s
  std::vector<double> sources;  ///< in A: one, or up to four around it to interpolate between
};

/// Finds each of `wanted` (ascending times of B) among the times of A: to 1e-9 of `last`, or between others
/// where `interpolate`. Times that cannot be had are faults of A and left out.
std::vector<TimeMatch> match_times(ForeignTable& a, std::span<const double> wanted, double last,
                                   bool interpolate);

/// The particles of A at the time of the match: read, or by the cubic (parabola, line) through the sources.
/// `blocks` are those of the sources, in order. Faults when the particles are not the same at all sources.
ParticleBlock block_at(ForeignTable& a, const TimeMatch& match, std::span<const ParticleBlock> blocks);

/// Indices (A, B) of the particles with the same X, to a thousandth of the smallest distance in B. Particles
/// without a counterpart are faults of A.
std::vector<std::pair<std::size_t, std::size_t>> match_particles(ForeignTable& a, const ParticleBlock& mine,
                                                                 const ParticleBlock& golden);

}  // namespace hompm::detail
