#pragma once

#include <Eigen/Core>
#include <array>
#include <concepts>

#include "railtab/runtime/base/lane_numbers.hpp"
#include "railtab/runtime/contact/reflection.hpp"
#include "railtab/runtime/contact/wheel_contact.hpp"

namespace railtab {

/// Motions of a wheelset and of the rail head under its right wheel (WheelsetMotion, RailHeadMotion): of one wheel, or
/// of several side by side.
template <class V>
struct WheelMotion {
  std::array<V, 6> displacement, velocity;
  std::array<V, 3> rail, rail_velocity;
  V rail_yaw, rail_slope;
  V friction;  ///< RailHeadMotion::friction

  /// @param place of this wheel among those side by side
  void set(int place, const WheelsetMotion& wheelset, const RailHeadMotion& head) noexcept {
    for (std::size_t k = 0; k < 6; ++k) {
      lane(displacement[k], place) = wheelset.displacement[static_cast<Eigen::Index>(k)];
      lane(velocity[k], place) = wheelset.velocity[static_cast<Eigen::Index>(k)];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      lane(rail[k], place) = head.displacement[static_cast<Eigen::Index>(k)];
      lane(rail_velocity[k], place) = head.velocity[static_cast<Eigen::Index>(k)];
    }
    lane(rail_yaw, place) = head.yaw;
    lane(rail_slope, place) = head.slope;
    lane(friction, place) = head.friction;
  }
};

/// Where right wheels are and how they move against their rails, in rail-head axes.
template <class V>
struct WheelKinematics {
  using Vector = std::array<V, 3>;

  V y, z, roll, yaw;     ///< WheelsetPose
  V centre_y, centre_z;  ///< of the wheelset centre from the rail-head origin [m]
  V cos_roll, sin_roll, cos_yaw, sin_yaw;
  V rail_cos, rail_sin;  ///< of the rail's roll: to and from track axes
  V rail_rate;           ///< of the rail's roll [rad/s]
  V turning;             ///< about the axle [rad/s]
  Vector velocity;       ///< of the wheelset centre against the rail's material at its origin, x along the rail [m/s]
  Vector swaying;        ///< roll and yaw rates of the wheelset against the rail [rad/s]
  Vector axle;           ///< unit vector
  Vector rotation;       ///< of the wheelset against the rail, that about its axle included [rad/s]

  /// @param speed V of the train [m/s]
  WheelKinematics(const WheelRailPair& pair, const WheelMotion<V>& motion, double speed) noexcept {
    const std::array<V, 6>&q = motion.displacement, &v = motion.velocity;
    const std::array<V, 3>&r = motion.rail, &rv = motion.rail_velocity;
    const SineCosineOf<V> of_rail(r[2]);
    rail_cos = of_rail.cosine;
    rail_sin = of_rail.sine;
    rail_rate = rv[2];
    const V dy = q[1] - r[0] - pair.rail_offset(), dz = q[2] - r[1] - pair.nominal_radius();
    centre_y = rail_cos * dy + rail_sin * dz;
    centre_z = rail_cos * dz - rail_sin * dy;
    y = centre_y + pair.rail_offset();
    z = centre_z + pair.nominal_radius();
    roll = q[3] - r[2];
    yaw = q[5] - motion.rail_yaw;
    // Velocity of the wheelset centre against the rail's material, along the rail's tangent (1, yaw, slope).
    velocity =
        from_track(v[0] + speed, v[1] - rv[0] - speed * motion.rail_yaw, v[2] - rv[1] - speed * motion.rail_slope);
    const SineCosineOf<V> of_roll(roll), of_yaw(yaw);
    cos_roll = of_roll.cosine;
    sin_roll = of_roll.sine;
    cos_yaw = of_yaw.cosine;
    sin_yaw = of_yaw.sine;
    axle = {-sin_yaw, cos_yaw * cos_roll, cos_yaw * sin_roll};
    turning = v[4] - speed / pair.nominal_radius();
    swaying = from_track(v[3] - rail_rate, V{}, v[5]);
    for (std::size_t i = 0; i < 3; ++i) rotation[i] = swaying[i] + turning * axle[i];
  }

  [[nodiscard]] Vector from_track(const V& x, const V& across, const V& down) const noexcept {
    return {x, rail_cos * across + rail_sin * down, rail_cos * down - rail_sin * across};
  }
  [[nodiscard]] Vector to_track(const V& x, const V& across, const V& down) const noexcept {
    return {x, rail_cos * across - rail_sin * down, rail_sin * across + rail_cos * down};
  }
  [[nodiscard]] WheelsetPose pose() const noexcept requires std::same_as<V, double> { return {y, z, roll, yaw}; }
};

/// Of one wheel, a left one seen in the mirror. @param speed V of the train [m/s]
[[nodiscard]] inline WheelKinematics<double> right_wheel(const WheelRailPair& pair, WheelSide side,
                                                         const WheelsetMotion& wheelset, const RailHeadMotion& rail,
                                                         double speed) noexcept {
  WheelMotion<double> motion;
  motion.set(0, on_right(side, wheelset), on_right(side, rail));
  return {pair, motion, speed};
}

}  // namespace railtab
