#pragma once

#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

/// What a wheelset of rotational inertia Jy [kg m²] about its axle adds by rolling: gyroscopic moments at a rotation of
/// 1 rad/s, and the load of a rotation that changes with the train's speed.
/// @param wheelset index of its body; matrices and acceleration_load have their sizes
void add_rolling(VehicleModel& vehicle, int wheelset, double Jy);

/// Supports the wheelsets in z and roll and takes their reactions to the weight [N] of all dofs.
/// @throws InputError where a weight is not carried by the wheelsets through springs
[[nodiscard]] Eigen::VectorXd wheelset_reactions(const VehicleModel& vehicle, const Eigen::VectorXd& weight);

}  // namespace railtab
