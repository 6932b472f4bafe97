// Which rows of another code's results belong to which of a golden folder.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hompm/verify/particle_table.hpp>

namespace hompm::detail {

/// A time of B and how to get it from A.
struct TimeMatch {
  double time = 0.0;            ///< in B, s
  std::vector<double> sources;  ///< in A: one, or up to four around it to interpolate between
};

/// Finds each of `wanted` (ascending times of B) among the times of A: to `tolerance` (s), or between others
/// where `interpolate`. Times that cannot be had are faults of A and left out; where A ends within 1 % before
/// the last of several, a note.
std::vector<TimeMatch> match_times(ParticleTable& a, std::span<const double> wanted, double tolerance,
                                   bool interpolate);

/// The particles of A at the time of the match: read, or by the cubic (parabola, line) through the sources.
/// `blocks` are those of the sources, in order. Faults when the particles are not the same at all sources.
ParticleBlock block_at(ParticleTable& a, const TimeMatch& match, std::span<const ParticleBlock> blocks);

/// Indices (A, B) of particles.
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// The particles of the same body, where both sides tell, and X, to a thousandth of the smallest distance in
/// B, or of `cell` (m) where B has one particle. Particles without a counterpart are faults of A, or notes
/// where none is `needed`.
Pairs match_particles(ParticleTable& a, const ParticleBlock& mine, const ParticleBlock& golden, double cell,
                      bool needed);

}  // namespace hompm::detail
