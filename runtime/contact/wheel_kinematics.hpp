#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "railtab/runtime/contact/wheel_contact.hpp"

namespace railtab {

/// Motions of a wheelset and of the rail head under one wheel, of numbers or of dual numbers; order as in
/// WheelsetMotion and RailHeadMotion.
template <class T>
struct WheelMotions {
  std::array<T, 6> displacement, velocity;
  std::array<T, 3> rail, rail_velocity;
  double rail_yaw, rail_slope;

  /// Those of numbers.
  [[nodiscard]] static WheelMotions of(const WheelsetMotion& w, const RailHeadMotion& r) {
    WheelMotions m;
    m.rail_yaw = r.yaw;
    m.rail_slope = r.slope;
    for (Eigen::Index i = 0; i < 6; ++i) {
      m.displacement[static_cast<std::size_t>(i)] = T(w.displacement[i]);
      m.velocity[static_cast<std::size_t>(i)] = T(w.velocity[i]);
    }
    for (Eigen::Index i = 0; i < 3; ++i) {
      m.rail[static_cast<std::size_t>(i)] = T(r.displacement[i]);
      m.rail_velocity[static_cast<std::size_t>(i)] = T(r.velocity[i]);
    }
    return m;
  }

  /// Reflection in the track's plane of symmetry: polar vectors lose the sign of y, axial ones of x and z. The left
  /// wheel is computed as the right wheel of the reflected world.
  void reflect() {
    for (const std::size_t i : {1U, 3U, 5U}) {
      displacement[i] = -displacement[i];
      velocity[i] = -velocity[i];
    }
    for (const std::size_t i : {0U, 2U}) {
      rail[i] = -rail[i];
      rail_velocity[i] = -rail_velocity[i];
    }
    rail_yaw = -rail_yaw;
  }
};

/// Where a right wheel is and how it moves against its rail, in rail-head axes.
template <class T>
struct WheelKinematics {
  using Vector = std::array<T, 3>;

  T y, z, roll, yaw;     ///< WheelsetPose
  T centre_y, centre_z;  ///< of the wheelset centre from the rail-head origin [m]
  T rail_cos, rail_sin;  ///< of the rail's roll: to and from track axes
  T rail_rate;           ///< of the rail's roll [rad/s]
  Vector velocity;       ///< of the wheelset centre against the rail's material at its origin, x along the rail [m/s]
  Vector axle;           ///< unit vector
  Vector rotation;       ///< of the wheelset against the rail, that about its axle included [rad/s]

  WheelKinematics(const WheelRailPair& pair, const WheelMotions<T>& m, double V) {
    using std::cos, std::sin;
    rail_cos = cos(m.rail[2]);
    rail_sin = sin(m.rail[2]);
    rail_rate = m.rail_velocity[2];
    const T dy = m.displacement[1] - m.rail[0] - pair.rail_offset();
    const T dz = m.displacement[2] - m.rail[1] - pair.nominal_radius();
    centre_y = rail_cos * dy + rail_sin * dz;
    centre_z = rail_cos * dz - rail_sin * dy;
    y = centre_y + pair.rail_offset();
    z = centre_z + pair.nominal_radius();
    roll = m.displacement[3] - m.rail[2];
    yaw = m.displacement[5] - m.rail_yaw;
    // Velocity of the wheelset centre against the rail's material, along the rail's tangent (1, yaw, slope).
    velocity = from_track(m.velocity[0] + V, m.velocity[1] - m.rail_velocity[0] - V * m.rail_yaw,
                          m.velocity[2] - m.rail_velocity[1] - V * m.rail_slope);
    const T cos_yaw = cos(yaw);
    axle = {-sin(yaw), cos_yaw * cos(roll), cos_yaw * sin(roll)};
    const T turning = m.velocity[4] - V / pair.nominal_radius();
    rotation = from_track(m.velocity[3] - m.rail_velocity[2], T(0.0), m.velocity[5]);
    for (std::size_t i = 0; i < 3; ++i) rotation[i] += turning * axle[i];
  }

  [[nodiscard]] Vector from_track(const T& x, const T& across, const T& down) const {
    return {x, rail_cos * across + rail_sin * down, rail_cos * down - rail_sin * across};
  }

  /// Velocity of the wheel's particle at `arm` from the wheelset centre against the rail's particle there. The rail's
  /// own roll rate turns its surface about the rail-head origin; `rotation` counts it about the wheelset centre.
  [[nodiscard]] Vector slip_velocity(const Vector& arm) const {
    return {velocity[0] + rotation[1] * arm[2] - rotation[2] * arm[1],
            velocity[1] + rotation[2] * arm[0] - rotation[0] * arm[2] + rail_rate * centre_z,
            velocity[2] + rotation[0] * arm[1] - rotation[1] * arm[0] - rail_rate * centre_y};
  }

  /// Generalised forces on wheelset (6) and rail head (3) in track axes, of a force on the wheel and its moment about
  /// the wheelset centre in rail-head axes: as WheelForce::patch, of the right wheel.
  [[nodiscard]] std::array<T, 9> generalised(const Vector& f, const Vector& m) const {
    const T fy = rail_cos * f[1] - rail_sin * f[2], fz = rail_sin * f[1] + rail_cos * f[2];
    return {f[0],
            fy,
            fz,
            m[0],
            m[0] * axle[0] + m[1] * axle[1] + m[2] * axle[2],
            rail_sin * m[1] + rail_cos * m[2],
            -fy,
            -fz,
            -(m[0] + centre_y * f[2] - centre_z * f[1])};
  }
};

/// Back from the reflected world (WheelMotions::reflect).
template <class T>
void reflect_force(std::array<T, 9>& force) {
  for (const std::size_t i : {1U, 3U, 5U, 6U, 8U}) force[i] = -force[i];
}

}  // namespace railtab
