#pragma once

#include <Eigen/Core>
#include <vector>

#include "railtab/runtime/line/ground_motion.hpp"
#include "railtab/runtime/vsi/rail_contact.hpp"

namespace railtab {

/// Translations of supports with their rates, y and z of each in turn [m], [m/s], [m/s²].
struct SupportMotion {
  Eigen::VectorXd displacement, velocity, acceleration;
};
/// At positions x [m] along the track.
[[nodiscard]] SupportMotion support_motion(const GroundMotion& ground, const std::vector<double>& x, double time);

/// What supports carry a rail head by: y, z [m], roll, the slopes yaw = dy/dx and pitch = −dz/dx [rad], and the
/// curvature d²z/dx² [1/m]; of the translations' rates its rates. Zero where displacements are absolute.
using CarriedHead = Eigen::Matrix<double, 6, 1>;
[[nodiscard]] CarriedHead carried_head(const RailContact& contact, const StructureSupports& supports,
                                       const Eigen::VectorXd& translations) noexcept;

/// Supports in as few columns as the ground's motion has places; those of a wave stay as they are.
[[nodiscard]] StructureSupports gathered(const StructureSupports& supports, const GroundMotion& ground);

}  // namespace railtab
