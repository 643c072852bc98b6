#pragma once

#include "railtab/runtime/contact/wheel_contact.hpp"

namespace railtab {

// Reflection in the track's plane of symmetry: polar vectors lose the sign of y, axial ones of x and z. The left wheel
// is computed as the right wheel of the reflected world.

[[nodiscard]] inline Vector6 reflected(const Vector6& v) { return {v[0], -v[1], v[2], -v[3], v[4], -v[5]}; }
/// y, z and roll of a rail head.
[[nodiscard]] inline Vector3 reflected_rail(const Vector3& v) { return {-v[0], v[1], -v[2]}; }
/// Generalised forces on wheelset (6) and rail head (3).
[[nodiscard]] inline Vector9 reflected(const Vector9& v) {
  Vector9 r;
  r << reflected(Vector6(v.head<6>())), reflected_rail(v.tail<3>());
  return r;
}

[[nodiscard]] inline WheelsetMotion on_right(WheelSide side, const WheelsetMotion& m) {
  return side == WheelSide::right ? m : WheelsetMotion{reflected(m.displacement), reflected(m.velocity)};
}
[[nodiscard]] inline RailHeadMotion on_right(WheelSide side, const RailHeadMotion& m) {
  if (side == WheelSide::right) return m;
  return {reflected_rail(m.displacement), reflected_rail(m.velocity), -m.yaw, m.slope, m.friction};
}

}  // namespace railtab
