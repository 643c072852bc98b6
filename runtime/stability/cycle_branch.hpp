#pragma once

#include <functional>
#include <vector>

#include "railtab/runtime/stability/periodic_motion.hpp"

namespace railtab {

/// A periodic motion of a branch.
struct BranchCycle {
  PeriodicMotion motion;
  Eigen::VectorXcd multipliers;     ///< of Floquet, largest first, without that along the motion
  BranchTangent tangent;            ///< of length 1 in units of the branch, forward
  double residual = 0.0;            ///< Shooting::residual()
  double error_along_motion = 0.0;  ///< Shooting::error_along_motion()
  double parameter_error = 0.0;     ///< Shooting::parameter_error()

  [[nodiscard]] bool is_stable() const { return std::abs(multipliers[0]) < 1.0; }
};

/// How a branch is followed: by steps along its tangent in the plane of height and parameter.
struct BranchSearch {
  BranchPoint unit{1.0, 1.0};                                          ///< what counts as one along either axis
  double first_step = 0.05, smallest_step = 1e-3, largest_step = 0.5;  ///< in these units
  double lowest_parameter = 0.0, highest_parameter = 1.0;
  double lowest_height = 0.0, highest_height = 1.0;
  double time_step = 1e-3;  ///< longest [s]
  int max_cycles = 400;
  double parameter_tolerance = 1e-4;  ///< of a fold
  ShootingLimits shooting{};
};

/// Where a branch begins, and which way it is followed.
struct CycleBranchStart {
  PeriodicMotion guess;  ///< near the first motion
  BranchLine line;       ///< on which that is sought
  BranchPoint forward;   ///< its height, or its parameter, grows or falls
};

/// Why a branch ends.
enum class BranchEnd {
  parameter_range,  ///< it leaves the range of the parameter
  height_range,     ///< it leaves the range of heights
  max_cycles,       ///< it may go on
  no_convergence,   ///< Newton's method fails at the smallest step
  stopped,          ///< by the listener
};

struct CycleBranch {
  std::vector<BranchCycle> cycles;  ///< in the order of the branch
  BranchEnd end = BranchEnd::no_convergence;
};

/// The steps that a period takes.
[[nodiscard]] SteppedTime stepped_time(double duration, double longest_step);

/// The periodic motion on a line. None: no convergence, or rest, which is a periodic motion too, of any period and at
/// any parameter: no motion below the lowest height counts.
[[nodiscard]] std::optional<BranchCycle> cycle_near(Shooting& shooting, const CycleSection& section,
                                                    const PeriodicMotion& guess, const BranchLine& line,
                                                    const BranchSearch& search);

/// Follows the branch of a periodic motion by pseudo-arclength continuation [Keller1977].
/// @param listener called with every motion found; false ends the search
[[nodiscard]] CycleBranch follow_branch(const Flow& flow, const CycleSection& section, const CycleBranchStart& start,
                                        const BranchSearch& search,
                                        const std::function<bool(const BranchCycle&)>& listener);

}  // namespace railtab
