#pragma once

#include <Eigen/Core>
#include <cmath>

#include "railtab/runtime/contact/creep_law.hpp"

namespace railtab {

/// Contact axes: x forward, y across in the tangent plane (to the right), z the normal into the rail.
struct ContactAxes {
  Eigen::Vector3d tangent, normal;  ///< y and z
  /// @param angle contact angle, rotation about x from z to the normal into the rail [rad]
  explicit ContactAxes(double angle) noexcept
      : tangent(0.0, std::cos(angle), std::sin(angle)), normal(0.0, -std::sin(angle), std::cos(angle)) {}
};

/// Creepages of a contact patch, in contact axes.
struct PatchCreepage {
  double x = 0.0;     ///< υx, longitudinal [-]
  double y = 0.0;     ///< υy, lateral [-]
  double spin = 0.0;  ///< φ, about the normal into the rail [1/m]
};

/// Motion of a wheelset's body against the material of the rail, all components along the same axes
/// (x forward, y right, z down), before division by the running speed.
struct RelativeMotion {
  Eigen::Vector3d velocity;          ///< of the wheelset centre, minus that of the rail's particle at the patch [m/s]
  Eigen::Vector3d angular_velocity;  ///< of the wheelset with its rotation about the axle (nominally -V/R0 about y),
                                     ///< minus that of the rail [rad/s]
};

/// Creepages from rigid-body kinematics: the velocity of the wheel's particle at the contact point against the rail's
/// particle there, and the relative rotation about the normal, divided by the running speed [Kalker1990, Sec. 1.3].
///
/// A wheel that turns slower than it rolls (braked) slides forward: υx > 0, and the creep force on it points backward.
/// A right wheel (angle < 0) rolling freely has φ = V sin(angle)/(R0 V) < 0.
/// @param arm from the wheelset centre to the contact point [m]
/// @param speed running speed V > 0 [m/s]
[[nodiscard]] PatchCreepage patch_creepage(const RelativeMotion& motion, const Eigen::Vector3d& arm,
                                           const ContactAxes& axes, double speed) noexcept;

/// Creepages normalised by G ab/(μF_n), spin by G (ab)^{3/2}/(μF_n): what creep_force() takes.
/// @param a, b semi-axes [m]
/// @param G combined shear modulus, 1/G = (1/G_w + 1/G_r)/2 [Pa]; @param mu_Fn friction bound μF_n > 0 [N]
[[nodiscard]] Creepage normalised_creepage(const PatchCreepage& creepage, double a, double b, double G,
                                           double mu_Fn) noexcept;

/// Creep force on the wheel in contact axes: F_x, F_y [N], M_z about the normal into the rail [N m].
struct PatchCreepForce {
  double x = 0.0, y = 0.0, moment = 0.0;
};

/// Back from normalised: force by μF_n, moment by μF_n √(ab).
[[nodiscard]] PatchCreepForce dimensional_creep_force(const CreepForce& force, double a, double b,
                                                      double mu_Fn) noexcept;

}  // namespace railtab
