#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "railtab/runtime/contact/contact_patch.hpp"

namespace railtab {

struct ContactProblem;
struct ContactSolution;
struct NewtonWorkspace;
struct TrainContact;

/// Contact forces at the estimated displacements of a time step: those at the end of the step before, what the motion
/// from there changes them by to first order, and the error of this estimate in the steps before: the track passes
/// smoothly under the wheels, and the error changes slowly. That error is to be added where wheels are computed side by
/// side and their tangents are new: what an old tangent leaves of its change does work on wheels that bounce. The
/// estimated displacements keep velocities, and thereby most of the creepages, but not how far each wheel presses into
/// its rail: where a rail bends under it that changes by a micrometre, and the force by some kN. Mean forces over a
/// step (ContactProblem::start) do not follow the motion.
class ForceEstimate {
 public:
  void forget() noexcept {
    end_.clear();
    known_ = 0;
  }
  /// @param start contacts at the end of the step before
  /// @param workspace its tangents
  /// @param goes_on whether the error is added
  /// @param estimate displacement, and the forces at the end of the step before, to which the changes are added
  void add_to(const TrainContact& train, const ContactProblem& problem, const ContactSolution& start,
              const NewtonWorkspace& workspace, bool goes_on, ContactSolution& estimate);
  /// @param end the solution of the step that add_to() was called for
  void learn(const TrainContact& train, const ContactProblem& problem, const NewtonWorkspace& workspace,
             const ContactSolution& end);

 private:
  struct Wheel {
    WheelsetPose pose;
    double slip;  ///< lateral velocity of the wheel's tread against the rail [m/s]
  };
  [[nodiscard]] static Wheel wheel_at(const TrainContact& train, const ContactProblem& problem,
                                      const Eigen::VectorXd& displacement, std::size_t wheel);
  void add_motion(const TrainContact& train, const ContactProblem& problem, const ContactSolution& start,
                  const NewtonWorkspace& workspace, ContactSolution& estimate) const;
  void add_error(Eigen::VectorXd& force) const;

  static constexpr int steps = 3;
  std::vector<Wheel> end_;                    // of the step before
  int known_ = 0;                             // steps whose error is known
  double velocity_rate_ = 0.0;                // of the step before, which says how long it was
  bool goes_on_ = false;                      // whether the error of this step will be wanted
  Eigen::VectorXd displacement_, force_;      // estimated, without the error of the steps before
  std::array<Eigen::VectorXd, steps> error_;  // of the steps before, the last first
};

}  // namespace railtab
