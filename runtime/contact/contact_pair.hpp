#pragma once

#include <cmath>

#include "railtab/runtime/contact/contact_patch.hpp"
#include "railtab/runtime/profile/wheel_rail_pair.hpp"

namespace railtab {

/// The wheel's silhouette seen along the rail, at one wheel-profile point, before roll: the candidate on each wheel
/// section is where the wheel's normal has no longitudinal component, sin(theta) = -tan(yaw) R'/a', in closed form.
/// With it the three-dimensional contact of a surface of revolution on a prism is that of two plane curves.
struct SilhouettePoint {
  double x;         ///< longitudinal position relative to the wheelset centre [m]
  double y, z;      ///< lateral and vertical position relative to the wheelset centre, axes yawed not rolled [m]
  double dy, dz;    ///< d/ds of y, z; parallel to (ty, tz)
  double ty, tz;    ///< tangent direction from the surface normal (first derivatives only), not normalised
  double dty, dtz;  ///< d/ds of ty, tz
  double speed;     ///< (dy, dz) = speed·(ty, tz); not positive where the section's point is no lowest one along x
  bool exists;      ///< false where the section has no such point: steep flank at large yaw, normal not downward
};

/// sin and cos to rounding; of the small angles of a wheelset by their series, a tenth of the library's time.
struct SineCosine {
  double sine, cosine;
  explicit SineCosine(double angle) noexcept : sine(0.0), cosine(1.0) {
    if (angle == 0.0) return;             // most tracks have no cross-level
    constexpr double series_limit = 0.1;  // [rad] the first terms left out are 3e-18 of the sine, 3e-17 of the cosine
    const double x = angle * angle;
    if (x <= series_limit * series_limit) {
      sine = angle + angle * x * (-1.0 / 6 + x * (1.0 / 120 + x * (-1.0 / 5040 + x * (1.0 / 362880))));
      cosine = 1.0 + x * (-0.5 + x * (1.0 / 24 + x * (-1.0 / 720 + x * (1.0 / 40320))));
    } else {
      sine = std::sin(angle);
      cosine = std::cos(angle);
    }
  }
};

/// sin, cos, tan of yaw and roll, computed once per query.
struct PoseTrigonometry {
  explicit PoseTrigonometry(const WheelsetPose& pose) noexcept
      : PoseTrigonometry(SineCosine(pose.yaw), SineCosine(pose.roll)) {}
  PoseTrigonometry(const SineCosine& yaw, const SineCosine& roll) noexcept
      : sin_yaw(yaw.sine),
        cos_yaw(yaw.cosine),
        inverse_cos_yaw(1.0 / yaw.cosine),
        tan_yaw(yaw.sine * inverse_cos_yaw),
        sin_roll(roll.sine),
        cos_roll(roll.cosine) {}
  double sin_yaw, cos_yaw, inverse_cos_yaw, tan_yaw, sin_roll, cos_roll;
};

/// @param wheel wheel-profile point at arc length s
/// @param axial axial position of the tape circle from the wheelset centre [m]
/// @param radius nominal radius [m]
[[nodiscard]] inline SilhouettePoint silhouette_point(const CurvePoint& wheel, double axial, double radius,
                                                      const PoseTrigonometry& trig) noexcept {
  SilhouettePoint p{};
  const double a = axial + wheel.y;
  const double R = radius + wheel.z;
  const double t2 = trig.tan_yaw * trig.tan_yaw;
  const double inverse_dy = 1.0 / wheel.dy;
  const double m = wheel.dz * inverse_dy;
  const double w2 = 1.0 - t2 * m * m;
  p.exists = wheel.dy > 0.0 && w2 > 0.0;
  if (!p.exists) return p;
  const double w = std::sqrt(w2);
  const double inverse_w = 1.0 / w;
  const double dm = (wheel.ddz - m * wheel.ddy) * inverse_dy;
  const double dw = -t2 * m * dm * inverse_w;
  p.x = -trig.sin_yaw * (a + R * m);
  p.y = trig.cos_yaw * (a - t2 * R * m);
  p.z = R * w;
  p.ty = wheel.dy * w;
  p.tz = wheel.dz * trig.inverse_cos_yaw;
  p.dty = wheel.ddy * w + wheel.dy * dw;
  p.dtz = wheel.ddz * trig.inverse_cos_yaw;
  p.speed = trig.cos_yaw * (w - t2 * R * dm * inverse_dy * inverse_w);
  p.dy = p.speed * p.ty;
  p.dz = p.speed * p.tz;
  return p;
}

/// Centre of the wheelset in the rail-head frame [m].
struct WheelsetCentre {
  double y, z;
};
[[nodiscard]] inline WheelsetCentre wheelset_centre(const WheelRailPair& pair, const WheelsetPose& pose) noexcept {
  return {pose.y - pair.rail_offset(), pose.z - pair.nominal_radius()};
}

/// A silhouette point rolled and moved into the rail-head frame: position, tangent, their derivatives as above.
[[nodiscard]] inline SilhouettePoint placed(const SilhouettePoint& p, const WheelsetCentre& centre,
                                            const PoseTrigonometry& trig) noexcept {
  const double c = trig.cos_roll;
  const double s = trig.sin_roll;
  return {p.x,
          centre.y + c * p.y - s * p.z,
          centre.z + s * p.y + c * p.z,
          c * p.dy - s * p.dz,
          s * p.dy + c * p.dz,
          c * p.ty - s * p.tz,
          s * p.ty + c * p.tz,
          c * p.dty - s * p.dtz,
          s * p.dty + c * p.dtz,
          p.speed,
          p.exists};
}

enum class PairStatus : std::uint8_t { converged, not_converged, off_profile, not_a_minimum };

struct RefinedPair {
  ContactPatch patch;
  PairStatus status = PairStatus::not_converged;
  int iterations = 0;
  double residual = 0.0;  ///< size of the last Newton step [m]
};

/// Newton on (s_wheel, s_rail) for the common normal of wheel and rail at a pose: paper Eqs. 1-4,
/// t_r·d_wr = 0 and t_w·n_r = 0, from a starting pair. The kernel that tables, online search and the contact force
/// share. Needs first and second derivatives of the profiles only; a step is held to 1 mm. Allocation-free,
/// thread-safe. The pair returned is within `tolerance` [m] of the last iterate; the penetration's error is of its
/// square.
///
/// `not_a_minimum`: the pair found is a maximum or saddle of the distance: the relative curvature
/// kappa_r/(1 - kappa_r d) + kappa_w is not positive. `off_profile`: the pair lies beyond an end of a profile.
/// `not_converged`: no common normal within `max_iterations`, or the silhouette does not exist there; patch is void.
[[nodiscard]] RefinedPair refine_pair(const WheelRailPair& pair, const WheelsetPose& pose, const PoseTrigonometry& trig,
                                      double s_wheel, double s_rail, int max_iterations = 12,
                                      double tolerance = 1e-13) noexcept;

/// refine_pair() for a start that is nearly right already, the table's: where a Newton step is below 20 µm and stays on
/// the same pieces of both profiles, it is applied to the curves' cubics instead of being evaluated again. The pair's
/// error is of the square of that step times the relative change of curvature, a nanometre as a rule; the penetration,
/// stationary there, is exact to rounding. A step across a joint of a profile is evaluated again.
/// @param patch set where the result is `converged`, void otherwise
[[nodiscard]] PairStatus polish_pair(const WheelRailPair& pair, const WheelsetCentre& centre,
                                     const PoseTrigonometry& trig, double s_wheel, double s_rail,
                                     ContactPatch& patch) noexcept;

/// The geometry of a given pair as it stands: penetration is the wheel point's depth along the rail point's normal.
/// The silhouette must exist at s_wheel.
[[nodiscard]] ContactPatch patch_of_pair(const WheelRailPair& pair, const WheelsetPose& pose,
                                         const PoseTrigonometry& trig, double s_wheel, double s_rail) noexcept;

/// A wheel that just touches the rail, on one local minimum of the vertical gap at fixed lateral shift, roll and yaw.
struct TouchPoint {
  double z_touch = 0.0;        ///< z of the pose [m]
  double s_wheel = 0.0;        ///< arc length on the wheel profile [m]
  double s_rail = 0.0;         ///< arc length on the rail profile [m]
  double z_touch_dy = 0.0;     ///< d z_touch / d pose.y = tan(contact angle), exact [-]
  double s_wheel_dy = 0.0;     ///< d s_wheel / d pose.y, by the implicit function theorem [-]
  double s_rail_dy = 0.0;      ///< d s_rail / d pose.y, likewise [-]
  double z_touch_droll = 0.0;  ///< d z_touch / d pose.roll, exact [m/rad]
};

struct RefinedTouch {
  TouchPoint touch;
  PairStatus status = PairStatus::not_converged;
};

/// The geometry of a given touching pair as it stands (y_wheel = y_rail, common tangent). pose.z is not used.
[[nodiscard]] TouchPoint touch_of_pair(const WheelRailPair& pair, const WheelsetPose& pose,
                                       const PoseTrigonometry& trig, double s_wheel, double s_rail) noexcept;

/// As refine_pair(), for a touching wheel: Newton on y_wheel = y_rail, t_w·n_r = 0. pose.z is not used.
[[nodiscard]] RefinedTouch refine_touch(const WheelRailPair& pair, const WheelsetPose& pose,
                                        const PoseTrigonometry& trig, double s_wheel, double s_rail,
                                        int max_iterations = 12, double tolerance = 1e-13) noexcept;

}  // namespace railtab
