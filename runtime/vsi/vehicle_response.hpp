#pragma once

#include <Eigen/Core>

#include "railtab/runtime/vehicle/vehicle_model.hpp"
#include "railtab/runtime/vsi/linear_motion.hpp"

namespace railtab {

/// Inverse of a vehicle's effective matrix or a part of it. @throws ComputationError where there is none
[[nodiscard]] Eigen::MatrixXd effective_inverse(const Eigen::MatrixXd& effective);

/// The linear part of one kind of vehicle for one time-step size: the inverse of its effective matrix,
/// dense, and its restriction to the wheelsets.
class VehicleResponse {
 public:
  /// @param damping of the vehicle with its gyroscopic terms at the running speed
  VehicleResponse(const VehicleModel& vehicle, const Eigen::MatrixXd& damping, const HhtScheme& scheme);
  /// At rest: K̄ = K + regularisation·M.
  VehicleResponse(const VehicleModel& vehicle, double regularisation);

  /// Increment over the predictor without contact forces at the end of the step.
  /// @param load of the step on the vehicle besides the contacts: vehicle_step_load()
  [[nodiscard]] Eigen::VectorXd free_increment(const VehicleModel& vehicle, const Eigen::MatrixXd& damping,
                                               const HhtScheme& scheme, const Eigen::VectorXd& load,
                                               const LinearMotion& motion, const Prediction& prediction) const;

  [[nodiscard]] const Eigen::MatrixXd& inverse() const noexcept { return inverse_; }
  /// Displacement of the wheelset dofs (6 per wheelset, held ones zero) from unit loads on them, (6w × 6w).
  [[nodiscard]] const Eigen::MatrixXd& compliance() const noexcept { return compliance_; }

 private:
  VehicleResponse(const VehicleModel& vehicle, const Eigen::MatrixXd& effective);

  Eigen::MatrixXd inverse_, compliance_;
};

}  // namespace railtab
