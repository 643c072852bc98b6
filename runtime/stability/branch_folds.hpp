#pragma once

#include <array>
#include <vector>

#include "railtab/runtime/stability/cycle_branch.hpp"

namespace railtab {

/// A fold of a branch: an extremum of its parameter.
struct BranchFold {
  BranchCycle cycle;                   ///< with the extreme parameter of those found
  std::array<BranchCycle, 2> bracket;  ///< on the branch before and after the fold
  bool converged = false;              ///< the parameters of all three agree to BranchSearch::parameter_tolerance
};

/// The folds of a branch, in its order: each extremum from which the parameter departs to both sides by more than the
/// tolerance of the search and twice the errors of the motions compared. Between neighbours whose tangents suggest an
/// extremum that neither shows, one more motion is sought. The extremum is located by parabolas over the chord of its
/// bracket and by bisection, within the bracket throughout; where motions are not found, the last bracket remains.
/// Extrema of which neither the motions nor their tangents show a trace are not found.
[[nodiscard]] std::vector<BranchFold> branch_folds(const Flow& flow, const CycleSection& section,
                                                   const CycleBranch& branch, const BranchSearch& search);

}  // namespace railtab
