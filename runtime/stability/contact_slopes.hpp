#pragma once

#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// ∂f/∂u and ∂f/∂u̇ of the contact forces of both wheels on one wheelset of straight rigid rails, by central
/// differences: x, y, z, roll, pitch, yaw [N/m, N/rad, …].
struct ContactSlopes {
  Eigen::Matrix<double, 6, 6> by_displacement, by_velocity;
};
/// @param travel lateral way over which the slope by y is a mean [m]: that of a time step, within which contact points
///        may jump; 0: the slope at the motion, of a loaded table over 0.1 mm
[[nodiscard]] ContactSlopes contact_slopes(const WheelContactModel& model, const WheelsetMotion& motion,
                                           double travel = 0.0);

/// The motion of each wheelset of the first vehicle.
[[nodiscard]] std::vector<WheelsetMotion> wheelset_motions(const VsiModel& model, const LinearMotion& motion);

/// Subtracts the slopes of one wheelset's contact forces from the matrices of its vehicle, dofs × dofs.
void subtract_contact_slopes(const VehicleModel& vehicle, int wheelset, const ContactSlopes& slopes,
                             Eigen::MatrixXd& stiffness, Eigen::MatrixXd& damping);

}  // namespace railtab
