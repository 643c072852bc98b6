#pragma once

#include <array>
#include <cstdint>

namespace railtab {

/// Pose of a wheelset against its right rail head [m, rad]. The rotation is Q = R_x(roll)·R_z(yaw).
///
/// y: lateral shift of the wheelset centre from the centred nominal position, to the right. z: lowering of the
/// wheelset centre from the height at which the nominal running circle is level with the rail-head origin, down.
/// The left wheel is the right wheel's mirror image: query (-y, z, -roll, -yaw), see mirrored().
struct WheelsetPose {
  double y = 0.0;
  double z = 0.0;
  double roll = 0.0;
  double yaw = 0.0;

  [[nodiscard]] constexpr WheelsetPose mirrored() const noexcept { return {-y, z, -roll, -yaw}; }
};

/// The method that found a contact patch.
enum class PatchSource : std::uint8_t {
  table,           ///< a branch of the geometry table, polished on the stored profiles
  online_convex,   ///< online search, common-normal Newton (Eqs. 1-4)
  online_concave,  ///< online search, overlap of the discretised profiles (Eqs. 5-10)
};

/// One contact patch of the right wheel: the deepest pair and the geometry there.
/// Rail coordinates in the rail-head frame, wheel coordinates in the wheel-profile frame.
struct ContactPatch {
  double s_wheel = 0.0;  ///< arc length on the wheel profile [m]
  double s_rail = 0.0;   ///< arc length on the rail profile [m]
  double y_rail = 0.0, z_rail = 0.0;
  double y_wheel = 0.0, z_wheel = 0.0;
  double x = 0.0;  ///< of the wheel's contact point, relative to the wheelset centre, forward [m]
  double angle =
      0.0;  ///< contact angle: rotation about x from z to the normal into the rail; negative on the right wheel [rad]
  double rolling_radius = 0.0;  ///< nominal radius + z_wheel: distance to the axle [m]
  double penetration = 0.0;     ///< common-normal distance of the deepest pair (Eq. 4), positive in contact [m]
  double curv_wheel = 0.0;      ///< lateral curvature of the wheel, convex positive [1/m]
  double curv_rail = 0.0;       ///< lateral curvature of the rail, convex positive [1/m]
  double curv_rolling =
      0.0;  ///< curvature of the wheel in the rolling direction, cos(angle to the axle's normal)/radius [1/m]
  bool concave = false;  ///< the wheel profile is concave there
  PatchSource source = PatchSource::online_convex;
};

/// The patches of one wheel, without heap allocation, in increasing y_rail.
struct ContactPatches {
  static constexpr int capacity = 8;
  ContactPatches() noexcept {}  // NOLINT(modernize-use-equals-default): the patches are not initialised
  union {
    std::array<ContactPatch, capacity> patch;  ///< the first `count`; the others are not initialised
  };
  int count = 0;
  bool from_table = false;  ///< from the geometry table, also where nothing touches
  bool overflow = false;    ///< more than `capacity` candidates: the deepest were kept

  void clear() noexcept {
    count = 0;
    from_table = overflow = false;
  }
  [[nodiscard]] const ContactPatch* begin() const noexcept { return patch.data(); }
  [[nodiscard]] const ContactPatch* end() const noexcept { return patch.data() + count; }
};

}  // namespace railtab
