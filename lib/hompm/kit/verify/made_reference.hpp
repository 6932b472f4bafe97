// A reference for any scene: runs of the scheme that is best for it, refined until their own error is known.
#pragma once

#include <optional>
#include <string>

#include <hompm/kit/verify/judge.hpp>

namespace hompm {

/// What the steps of a run cost, counted as particles × steps × what a particle takes in a step of the
/// scheme, in nanoseconds of a machine that is always the same.
double counted_work(const Scene& scene, const TimeStepping& stepping);

/// How much work (`counted_work`) may be spent on a reference: a fifth of that of the run, or 3e8 if that is
/// more; with `full` ten times the run, or 1e10.
double reference_budget(const Scene& scene, const TimeStepping& stepping, bool full);

/// The errors of the last snapshot against runs of the same scene: by `high-order`, in time by blanes-moan,
/// where the scene admits both, else with leapfrog, else by the scene's own scheme. Cells are doubled, and
/// the time step goes with them, until the own error is a tenth of what it is to judge or the next run would
/// be beyond the budget. Runs are compared as functions of X, each body by itself. From the differences of
/// the finest grid, d, and of the next, d2, follows the order q = log2(d2/d), and the own error of the
/// finest:
///
/// - 1.25 d/(2^q − 1), at most 3 d, with q no higher than in time: 1 with damping or viscosity, 2 with
/// leapfrog, 2.5;
///   `ErrorKind::computed` where fields converge as smooth ones do, q ≥ 1.5, else `extrapolated`;
/// - 1.25 d where q < 1.5 and the two differences point away from each other: the waves behind a jump, which
///   have nothing to do with each other from grid to grid; of the larger difference where q < 0.2;
/// - 3 d of two grids only; else 6 times the larger difference where no order shows, q < 0.2.
///
/// (P. J. Roache, J. Fluids Eng. 116 (1994) 405–413.) Nothing where not even two grids are within the budget
/// or none can be run; `reason` says why. What `watch` throws, is thrown.
std::optional<ErrorReport> judge_by_runs(const Scene& scene, const RunResult& result, double budget,
                                         std::string& reason, const ReferenceWatch& watch = {},
                                         const RunMotion& motion = {});

}  // namespace hompm
