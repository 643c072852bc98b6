#include "railtab/runtime/vsi/vehicle_response.hpp"

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

Eigen::MatrixXd effective_inverse(const Eigen::MatrixXd& effective) {
  Eigen::MatrixXd inverse = dense_inverse(effective);
  if (inverse.allFinite()) return inverse;
  throw ComputationError("the vehicle's effective matrix has no inverse: check masses and stiffnesses of the vehicle");
}

namespace {

Eigen::MatrixXd inverse_by_systems(const std::vector<SeparateSystem>& systems, const Eigen::MatrixXd& effective) {
  if (systems.size() == 1) return effective_inverse(effective);
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(effective.rows(), effective.cols());
  for (const SeparateSystem& system : systems) {
    inverse(system.dofs, system.dofs) = effective_inverse(effective(system.dofs, system.dofs));
  }
  return inverse;
}

}  // namespace

VehicleResponse::VehicleResponse(const VehicleModel& vehicle, const Eigen::MatrixXd& damping, const HhtScheme& scheme)
    : VehicleResponse(vehicle, separate_systems(vehicle), damping, scheme) {}

VehicleResponse::VehicleResponse(const VehicleModel& vehicle, const std::vector<SeparateSystem>& systems,
                                 const Eigen::MatrixXd& damping, const HhtScheme& scheme)
    : VehicleResponse(vehicle, systems, effective_matrix(scheme, vehicle.mass, damping, vehicle.stiffness)) {
  damping_ = damping.sparseView();
  stiffness_ = vehicle.stiffness.sparseView();
}

VehicleResponse::VehicleResponse(const VehicleModel& vehicle, const std::vector<SeparateSystem>& systems,
                                 double regularisation)
    : VehicleResponse(vehicle, systems, Eigen::MatrixXd(vehicle.stiffness + regularisation * vehicle.mass)) {}

VehicleResponse::VehicleResponse(const VehicleModel& vehicle, const std::vector<SeparateSystem>& systems,
                                 const Eigen::MatrixXd& effective)
    : inverse_(inverse_by_systems(systems, effective)), by_systems_(systems, inverse_) {
  const auto wheelsets = static_cast<int>(vehicle.wheelsets.size());
  compliance_ = Eigen::MatrixXd::Zero(6 * wheelsets, 6 * wheelsets);
  coupled_.resize(vehicle.wheelsets.size());
  const auto dof = [&](int wheelset, int k) {
    return vehicle.dof[index(vehicle.wheelsets[index(wheelset)])][index(k)];
  };
  for (const SeparateSystem& system : systems) {
    for (const int w : system.wheelsets) {
      coupled_[index(w)] = {system.wheelsets.front(), system.wheelsets.back() + 1};
      for (const int v : system.wheelsets) {
        for (int i = 0; i < 6; ++i) {
          for (int j = 0; j < 6; ++j) {
            const int row = dof(w, i), column = dof(v, j);
            if (row != held && column != held) compliance_(6 * w + i, 6 * v + j) = inverse_(row, column);
          }
        }
      }
    }
  }
}

void VehicleResponse::find_free_increment(const HhtScheme& scheme, const Eigen::VectorXd& load,
                                          const LinearMotion& motion, Prediction& prediction) const {
  Eigen::VectorXd& known = prediction.known;
  past_contact_load(scheme, motion, {0, motion.contact_load.size()}, known);
  known += load;
  known.noalias() -= damping_ * prediction.weighted_velocity;
  known.noalias() -= stiffness_ * prediction.weighted_displacement;
  prediction.increment.setZero(known.size());
  add_displacement(1.0, known, prediction.increment);
}

}  // namespace railtab
