#pragma once

#include <Eigen/Core>

#include "railtab/runtime/vehicle/vehicle_model.hpp"
#include "railtab/runtime/vsi/linear_motion.hpp"

namespace railtab {

/// The linear part of one kind of vehicle for one time-step size: the inverse of its effective matrix
/// K̄ = M·acceleration_rate + (1+α)(C·velocity_rate + K), dense, and its restriction to the wheelsets.
class VehicleResponse {
 public:
  /// @param damping of the vehicle with its gyroscopic terms at the running speed
  VehicleResponse(const VehicleModel& vehicle, const Eigen::MatrixXd& damping, const HhtScheme& scheme);
  /// At rest: K̄ = K + regularisation·M.
  VehicleResponse(const VehicleModel& vehicle, double regularisation);

  /// Increment over the predictor without contact forces at the end of the step.
  /// @param load of the step on the vehicle besides the contacts: vehicle_step_load()
  void free_increment(const VehicleModel& vehicle, const Eigen::MatrixXd& damping, const HhtScheme& scheme,
                      const Eigen::VectorXd& load, const LinearMotion& motion, const Prediction& prediction,
                      Eigen::VectorXd& increment) const;

  [[nodiscard]] const Eigen::MatrixXd& inverse() const noexcept { return inverse_; }
  /// Displacement of the wheelset dofs (6 per wheelset, held ones zero) from unit loads on them, (6w × 6w).
  [[nodiscard]] const Eigen::MatrixXd& compliance() const noexcept { return compliance_; }

 private:
  void restrict_to_wheelsets(const VehicleModel& vehicle);

  Eigen::MatrixXd inverse_, compliance_;
};

}  // namespace railtab
