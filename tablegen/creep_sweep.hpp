#pragma once

#include <functional>
#include <span>
#include <vector>

#include "railtab/tablegen/creep_layout.hpp"

namespace railtab {

/// How the cases of a creep table are solved: exact rolling contact on elements/2 and elements, extrapolated.
struct CreepSweepOptions {
  double poisson = 0.28;    ///< 0..0.5
  int elements = 40;        ///< of the fine grid along each axis of the ellipse, even, 8..240
  double tolerance = 1e-6;  ///< on the residual of each solution, 1e-12..1e-2

  /// @throws InputError
  void validate() const;
};

/// One solved case and what proves it; the proofs are the worse ones of the two grids.
struct SolvedCreepCase {
  CreepForce force;
  double residual = 0.0;         ///< of the friction law, relative to that of zero traction
  double bound_excess = 0.0;     ///< largest |p|/(μ p_n) − 1
  double slip_deviation = 0.0;   ///< Σ(|p||s| + p·s)/Σ|p||s| over slipping elements: 0 where slip opposes traction
  double grid_difference = 0.0;  ///< |force on the fine grid − on the coarse one|, twice what extrapolation adds
  bool safe_method = false;      ///< Newton's method failed on one of the grids, the slow one was used
};

/// Consecutive cases that one thread solves one after the other: the smallest piece of work. Which cases make up a line
/// depends on the list alone, so neither threads nor shards nor a kill in between change any value.
struct CreepLine {
  std::size_t first = 0, count = 0;
};

/// The cases in their order, cut where a/b changes and after 64 cases.
[[nodiscard]] std::vector<CreepLine> creep_lines(std::span<const CreepCase> cases);

/// The lines of one shard: every `shards`-th, so that each has its share of easy and of hard ones.
/// @param shard 1..shards
[[nodiscard]] std::vector<CreepLine> shard_lines(std::span<const CreepLine> lines, int shard, int shards);

/// Told the solutions of one line. Lines come in their order, one at a time, from any thread.
using CreepSink = std::function<void(std::span<const SolvedCreepCase>)>;

/// Solves lines in parallel (OpenMP). Every solution is checked: it is converged, and no element exceeds friction.
/// @throws InputError for options out of range, ComputationError naming a case that the safe method does not solve
/// either; lines before it have been told to `sink`. What `sink` throws ends the sweep likewise.
void sweep_creep(std::span<const CreepCase> cases, std::span<const CreepLine> lines, const CreepSweepOptions& options,
                 const CreepSink& sink);

}  // namespace railtab
