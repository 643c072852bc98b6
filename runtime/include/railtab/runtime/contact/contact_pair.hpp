#pragma once

#include "railtab/runtime/contact/contact_patch.hpp"
#include "railtab/runtime/profile/wheel_rail_pair.hpp"

namespace railtab {

/// The wheel's silhouette seen along the rail, at one wheel-profile point, before roll: the candidate on each wheel
/// section is where the wheel's normal has no longitudinal component, sin(theta) = -tan(yaw) R'/a', in closed form.
/// With it the three-dimensional contact of a surface of revolution on a prism is that of two plane curves.
struct SilhouettePoint {
  double x;          ///< longitudinal position relative to the wheelset centre [m]
  double y, z;       ///< lateral and vertical position relative to the wheelset centre, axes yawed not rolled [m]
  double dy, dz;     ///< d/ds of y, z
  double ty, tz;     ///< tangent direction from the surface normal (parallel to dy, dz), not normalised
  double dty, dtz;   ///< d/ds of ty, tz
  bool exists;       ///< false where the section has no such point (steep flank at large yaw)
};

/// sin, cos, tan of yaw and roll, computed once per query.
struct PoseTrigonometry {
  explicit PoseTrigonometry(const WheelsetPose& pose) noexcept;
  double sin_yaw, cos_yaw, tan_yaw, sin_roll, cos_roll;
};

/// @param wheel wheel-profile point at arc length s
/// @param axial axial position of the tape circle from the wheelset centre [m]
/// @param radius nominal radius [m]
[[nodiscard]] SilhouettePoint silhouette_point(const CurvePoint& wheel, double axial, double radius,
                                               const PoseTrigonometry& trig) noexcept;

enum class PairStatus : std::uint8_t { converged, not_converged, off_profile, not_a_minimum };

struct RefinedPair {
  ContactPatch patch;
  PairStatus status = PairStatus::not_converged;
  int iterations = 0;
  double residual = 0.0;  ///< size of the last Newton step [m]
};

/// Newton on (s_wheel, s_rail) for the common normal of wheel and rail at a pose: paper Eqs. 1-4,
/// t_r·d_wr = 0 and t_w·n_r = 0, from a starting pair. The kernel that tables, online search and the contact force share.
/// Needs first and second derivatives of the profiles only. Allocation-free, thread-safe.
///
/// `not_a_minimum`: the pair found is a maximum or saddle of the distance (relative curvature not positive).
[[nodiscard]] RefinedPair refine_pair(const WheelRailPair& pair, const WheelsetPose& pose, const PoseTrigonometry& trig,
                                      double s_wheel, double s_rail, int max_iterations = 12,
                                      double tolerance = 1e-13) noexcept;

}  // namespace railtab
