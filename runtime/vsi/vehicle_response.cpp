#include "railtab/runtime/vsi/vehicle_response.hpp"

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

Eigen::MatrixXd effective_inverse(const Eigen::MatrixXd& effective) {
  Eigen::MatrixXd inverse = dense_inverse(effective);
  if (inverse.allFinite()) return inverse;
  throw ComputationError("the vehicle's effective matrix has no inverse: check masses and stiffnesses of the vehicle");
}

VehicleResponse::VehicleResponse(const VehicleModel& vehicle, const Eigen::MatrixXd& damping, const HhtScheme& scheme)
    : VehicleResponse(vehicle, effective_matrix(scheme, vehicle.mass, damping, vehicle.stiffness)) {}

VehicleResponse::VehicleResponse(const VehicleModel& vehicle, double regularisation)
    : VehicleResponse(vehicle, Eigen::MatrixXd(vehicle.stiffness + regularisation * vehicle.mass)) {}

VehicleResponse::VehicleResponse(const VehicleModel& vehicle, const Eigen::MatrixXd& effective)
    : inverse_(effective_inverse(effective)) {
  const auto wheelsets = static_cast<Eigen::Index>(vehicle.wheelsets.size());
  compliance_ = Eigen::MatrixXd::Zero(6 * wheelsets, 6 * wheelsets);
  const auto dof = [&](Eigen::Index k) {
    return vehicle.dof[static_cast<std::size_t>(vehicle.wheelsets[static_cast<std::size_t>(k / 6)])]
                      [static_cast<std::size_t>(k % 6)];
  };
  for (Eigen::Index i = 0; i < 6 * wheelsets; ++i) {
    for (Eigen::Index j = 0; j < 6 * wheelsets; ++j) {
      if (dof(i) != held && dof(j) != held) compliance_(i, j) = inverse_(dof(i), dof(j));
    }
  }
}

Eigen::VectorXd VehicleResponse::free_increment(const VehicleModel& vehicle, const Eigen::MatrixXd& damping,
                                                const HhtScheme& scheme, const Eigen::VectorXd& load,
                                                const LinearMotion& motion, const Prediction& prediction) const {
  Eigen::VectorXd known;
  past_contact_load(scheme, motion, {0, motion.contact_load.size()}, known);
  known += load - damping * prediction.weighted_velocity - vehicle.stiffness * prediction.weighted_displacement;
  return inverse_ * known;
}

}  // namespace railtab
