#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "railtab/runtime/contact/wheel_contact.hpp"

namespace railtab {

// Reflection in the track's plane of symmetry: polar vectors lose the sign of y, axial ones of x and z. The left wheel
// is computed as the right wheel of the reflected world.

/// Whether motions, or generalised forces, of wheelset (6) and rail head (3) change their sign.
inline constexpr std::array<bool, 9> changes_sign{false, true, false, true, false, true, true, false, true};

/// @tparam first place of the vector among the nine
template <std::size_t first, class Vector>
[[nodiscard]] Vector reflected_from(Vector v) {
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    if (changes_sign[first + static_cast<std::size_t>(i)]) v[i] = -v[i];
  }
  return v;
}
[[nodiscard]] inline Vector6 reflected(const Vector6& v) { return reflected_from<0>(v); }
/// y, z and roll of a rail head.
[[nodiscard]] inline Vector3 reflected_rail(const Vector3& v) { return reflected_from<6>(v); }
/// Generalised forces on wheelset (6) and rail head (3).
[[nodiscard]] inline Vector9 reflected(const Vector9& v) { return reflected_from<0>(v); }

[[nodiscard]] inline WheelsetMotion on_right(WheelSide side, const WheelsetMotion& m) {
  return side == WheelSide::right ? m : WheelsetMotion{reflected(m.displacement), reflected(m.velocity)};
}
[[nodiscard]] inline RailHeadMotion on_right(WheelSide side, const RailHeadMotion& m) {
  if (side == WheelSide::right) return m;
  return {reflected_rail(m.displacement), reflected_rail(m.velocity), -m.yaw, m.slope, m.friction};
}

}  // namespace railtab
