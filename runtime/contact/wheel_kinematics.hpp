#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "railtab/runtime/contact/wheel_contact.hpp"

namespace railtab {

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

  WheelKinematics(const WheelRailPair& pair, const WheelsetMotion& wheelset, const RailHeadMotion& rail, double V) {
    const Vector6 &q = wheelset.displacement, &v = wheelset.velocity;
    const Vector3 &r = rail.displacement, &rv = rail.velocity;
    rail_cos = std::cos(r[2]);
    rail_sin = std::sin(r[2]);
    rail_rate = rv[2];
    const double dy = q[1] - r[0] - pair.rail_offset(), dz = q[2] - r[1] - pair.nominal_radius();
    centre_y = rail_cos * dy + rail_sin * dz;
    centre_z = rail_cos * dz - rail_sin * dy;
    y = centre_y + pair.rail_offset();
    z = centre_z + pair.nominal_radius();
    roll = q[3] - r[2];
    yaw = q[5] - rail.yaw;
    // Velocity of the wheelset centre against the rail's material, along the rail's tangent (1, yaw, slope).
    velocity = from_track(v[0] + V, v[1] - rv[0] - V * rail.yaw, v[2] - rv[1] - V * rail.slope);
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
