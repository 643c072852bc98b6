#pragma once

#include <Eigen/SparseCore>

#include "railtab/runtime/vehicle/separate_systems.hpp"
#include "railtab/runtime/vehicle/vehicle_model.hpp"
#include "railtab/runtime/vsi/linear_motion.hpp"

namespace railtab {

/// Wheelsets of a vehicle that follow each other, from `first` to before `end`.
struct WheelsetRange {
  int first, end;
};

/// Inverse of a vehicle's effective matrix or a part of it. @throws ComputationError where there is none
[[nodiscard]] Eigen::MatrixXd effective_inverse(const Eigen::MatrixXd& effective);

/// The linear part of one kind of vehicle for one time-step size: the inverse of its effective matrix, dense within
/// each separate system, and its restriction to the wheelsets.
class VehicleResponse {
 public:
  /// @param damping of the vehicle with its gyroscopic terms at the running speed
  VehicleResponse(const VehicleModel& vehicle, const Eigen::MatrixXd& damping, const HhtScheme& scheme);
  /// @param systems separate_systems(vehicle)
  VehicleResponse(const VehicleModel& vehicle, const std::vector<SeparateSystem>& systems,
                  const Eigen::MatrixXd& damping, const HhtScheme& scheme);
  /// At rest: K̄ = K + regularisation·M.
  VehicleResponse(const VehicleModel& vehicle, const std::vector<SeparateSystem>& systems, double regularisation);

  /// Sets the prediction's increment over the predictor without contact forces at the end of the step.
  /// @param load of the step on the vehicle besides the contacts: vehicle_step_load()
  void find_free_increment(const HhtScheme& scheme, const Eigen::VectorXd& load, const LinearMotion& motion,
                           Prediction& prediction) const;
  /// Displacement under a load on the dofs: inverse() · load.
  [[nodiscard]] Eigen::VectorXd displacement(const Eigen::VectorXd& load) const { return by_systems_ * load; }
  /// Adds the displacement under `factor` times a load.
  void add_displacement(double factor, const Eigen::VectorXd& load, Eigen::VectorXd& to) const {
    by_systems_.add_product(factor, load, to);
  }

  [[nodiscard]] const Eigen::MatrixXd& inverse() const noexcept { return inverse_; }
  /// Displacement of the wheelset dofs (6 per wheelset, held ones zero) from unit loads on them, (6w × 6w).
  [[nodiscard]] const Eigen::MatrixXd& compliance() const noexcept { return compliance_; }
  /// Per wheelset, the first and one past the last of those that are coupled with it.
  [[nodiscard]] const std::vector<WheelsetRange>& coupled() const noexcept { return coupled_; }

 private:
  VehicleResponse(const VehicleModel& vehicle, const std::vector<SeparateSystem>& systems,
                  const Eigen::MatrixXd& effective);

  Eigen::MatrixXd inverse_, compliance_;
  SeparateMatrix by_systems_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> damping_, stiffness_;
  std::vector<WheelsetRange> coupled_;
};

}  // namespace railtab
