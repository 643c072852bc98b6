#include "railtab/runtime/vsi/vehicle_response.hpp"

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& effective) {
  Eigen::MatrixXd inverse = dense_inverse(effective);
  if (inverse.allFinite()) return inverse;
  throw ComputationError("the vehicle's effective matrix has no inverse: check masses and stiffnesses of the vehicle");
}

}  // namespace

VehicleResponse::VehicleResponse(const VehicleModel& vehicle, const Eigen::MatrixXd& damping, const HhtScheme& scheme) {
  const Eigen::MatrixXd effective = scheme.acceleration_rate() * vehicle.mass +
                                    scheme.load_weight() * (scheme.velocity_rate() * damping + vehicle.stiffness);
  inverse_ = inverse_of(effective);
  restrict_to_wheelsets(vehicle);
}

VehicleResponse::VehicleResponse(const VehicleModel& vehicle, double regularisation) {
  const Eigen::MatrixXd effective = vehicle.stiffness + regularisation * vehicle.mass;
  inverse_ = inverse_of(effective);
  restrict_to_wheelsets(vehicle);
}

void VehicleResponse::restrict_to_wheelsets(const VehicleModel& vehicle) {
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

void VehicleResponse::free_increment(const VehicleModel& vehicle, const Eigen::MatrixXd& damping,
                                     const HhtScheme& scheme, const Eigen::VectorXd& load, const LinearMotion& motion,
                                     const Prediction& prediction, Eigen::VectorXd& increment) const {
  Eigen::VectorXd known;
  past_contact_load(scheme, motion, {0, motion.contact_load.size()}, known);
  known += load - damping * prediction.weighted_velocity - vehicle.stiffness * prediction.weighted_displacement;
  increment.noalias() = inverse_ * known;
}

}  // namespace railtab
