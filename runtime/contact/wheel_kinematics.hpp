#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "railtab/runtime/contact/wheel_contact.hpp"

namespace railtab {

/// Motions of a wheelset and of the rail head under one wheel.
struct WheelMotions {
  WheelsetMotion wheelset;
  RailHeadMotion rail;

  /// Reflection in the track's plane of symmetry: polar vectors lose the sign of y, axial ones of x and z. The left
  /// wheel is computed as the right wheel of the reflected world.
  void reflect() {
    for (const Eigen::Index i : {1, 3, 5}) {
      wheelset.displacement[i] = -wheelset.displacement[i];
      wheelset.velocity[i] = -wheelset.velocity[i];
    }
    for (const Eigen::Index i : {0, 2}) {
      rail.displacement[i] = -rail.displacement[i];
      rail.velocity[i] = -rail.velocity[i];
    }
    rail.yaw = -rail.yaw;
  }
};

/// Back from the reflected world.
inline void reflect_force(Vector9& force) {
  for (const Eigen::Index i : {1, 3, 5, 6, 8}) force[i] = -force[i];
}

/// Where a right wheel is and how it moves against its rail, in rail-head axes.
struct WheelKinematics {
  using Vector = std::array<double, 3>;

  double y, z, roll, yaw;     ///< WheelsetPose
  double centre_y, centre_z;  ///< of the wheelset centre from the rail-head origin [m]
  double cos_roll, sin_roll, cos_yaw, sin_yaw;
  double rail_cos, rail_sin;  ///< of the rail's roll: to and from track axes
  double rail_rate;           ///< of the rail's roll [rad/s]
  double turning;             ///< about the axle [rad/s]
  Vector velocity;  ///< of the wheelset centre against the rail's material at its origin, x along the rail [m/s]
  Vector swaying;   ///< roll and yaw rates of the wheelset against the rail [rad/s]
  Vector axle;      ///< unit vector
  Vector rotation;  ///< of the wheelset against the rail, that about its axle included [rad/s]

  WheelKinematics(const WheelRailPair& pair, const WheelMotions& m, double V) {
    const Vector6 &q = m.wheelset.displacement, &v = m.wheelset.velocity;
    const Vector3 &r = m.rail.displacement, &rv = m.rail.velocity;
    rail_cos = std::cos(r[2]);
    rail_sin = std::sin(r[2]);
    rail_rate = rv[2];
    const double dy = q[1] - r[0] - pair.rail_offset(), dz = q[2] - r[1] - pair.nominal_radius();
    centre_y = rail_cos * dy + rail_sin * dz;
    centre_z = rail_cos * dz - rail_sin * dy;
    y = centre_y + pair.rail_offset();
    z = centre_z + pair.nominal_radius();
    roll = q[3] - r[2];
    yaw = q[5] - m.rail.yaw;
    // Velocity of the wheelset centre against the rail's material, along the rail's tangent (1, yaw, slope).
    velocity = from_track(v[0] + V, v[1] - rv[0] - V * m.rail.yaw, v[2] - rv[1] - V * m.rail.slope);
    cos_roll = std::cos(roll);
    sin_roll = std::sin(roll);
    cos_yaw = std::cos(yaw);
    sin_yaw = std::sin(yaw);
    axle = {-sin_yaw, cos_yaw * cos_roll, cos_yaw * sin_roll};
    turning = v[4] - V / pair.nominal_radius();
    swaying = from_track(v[3] - rail_rate, 0.0, v[5]);
    for (std::size_t i = 0; i < 3; ++i) rotation[i] = swaying[i] + turning * axle[i];
  }

  [[nodiscard]] Vector from_track(double x, double across, double down) const {
    return {x, rail_cos * across + rail_sin * down, rail_cos * down - rail_sin * across};
  }
};

}  // namespace railtab
