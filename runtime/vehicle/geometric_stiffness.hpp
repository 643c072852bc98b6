#pragma once

#include <vector>

#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

/// Adds to the stiffness what the suspension carries at rest (preload_matrix). About the axle of a wheelset, whose
/// boxes do not turn with it, the other body takes the unit's whole couple.
/// @param rest displacement of all dofs under gravity on standing wheelsets [m], [rad]
void add_geometric_stiffness(VehicleModel& vehicle, const std::vector<Suspension>& suspension,
                             const Eigen::VectorXd& rest);

/// The weight of one body of a vehicle whose springs are not known.
struct CarriedWeight {
  int body = 0;
  double weight = 0.0;  ///< [N]
  double height = 0.0;  ///< z of the point where it is carried, vehicle frame [m]
};

/// The same for a vehicle that is known by its matrices. Each body's weight is taken to stand on the wheelsets alone,
/// in the shares in which they carry it, with the couple of its lateral motion against them shared by halves. Moments
/// about the rails are those of the true vehicle; which bodies they turn on their way there is an assumption.
void add_geometric_stiffness(VehicleModel& vehicle, const std::vector<CarriedWeight>& weights);

}  // namespace railtab
