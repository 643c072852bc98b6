#pragma once

#include <cmath>

#include "railtab/runtime/base/lane_numbers.hpp"
#include "railtab/runtime/contact/contact_patch.hpp"
#include "railtab/runtime/profile/wheel_rail_pair.hpp"

namespace railtab {

/// A vector (y, z) in the vertical plane across the track. Real: double, an array of lanes, a dual number.
template <class Real>
struct PlaneVector {
  Real y, z;
};

template <class Real>
[[nodiscard]] Real dot(const PlaneVector<Real>& p, const PlaneVector<Real>& q) noexcept {
  return p.y * q.y + p.z * q.z;
}
template <class Real>
[[nodiscard]] Real cross(const PlaneVector<Real>& p, const PlaneVector<Real>& q) noexcept {
  return p.y * q.z - p.z * q.y;
}

/// A point of the wheel's silhouette seen along the rail, axes yawed and, before placed(), not rolled. With the
/// silhouette the contact in space of a surface of revolution on a prism is that of two plane curves.
struct SilhouettePoint {
  double x;         ///< longitudinal position relative to the wheelset centre [m]
  double y, z;      ///< lateral and vertical position relative to the wheelset centre, axes yawed not rolled [m]
  double dy, dz;    ///< d/ds of y, z; parallel to (ty, tz)
  double ty, tz;    ///< tangent direction from the surface normal (first derivatives only), not normalised
  double dty, dtz;  ///< d/ds of ty, tz
  double speed;     ///< (dy, dz) = speed·(ty, tz); not positive where the section's point is no lowest one along x
  bool exists;      ///< false where the section has no such point: steep flank at large yaw, normal not downward
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

// On a wheel section of radius R at axial position a, with slope m = dR/da, the silhouette's point is where the wheel's
// normal has no longitudinal component, at the angle theta round the axle [MontenegroCalcada2023, Eq. 1;
// docs/theory/contact_search.md, section 1]:
//
//   sin(theta) = -m tan(yaw),   w = cos(theta) = sqrt(1 - m² tan²(yaw)),
//   x = -sin(yaw) (a + R m),    y = cos(yaw) (a - R m tan²(yaw)),    z = R w.
//
// Real: double, an array of lanes, or a dual number.

/// w²; no silhouette point exists where it is not positive: a steep flank at large yaw.
template <class Real>
[[nodiscard]] Real silhouette_cosine2(const Real& m, const PoseTrigonometry& trig) noexcept {
  const double t2 = trig.tan_yaw * trig.tan_yaw;
  return 1.0 - t2 * m * m;
}
template <class Real>
[[nodiscard]] Real silhouette_y(const Real& a, const Real& R, const Real& m, const PoseTrigonometry& trig) noexcept {
  const double t2 = trig.tan_yaw * trig.tan_yaw;
  return trig.cos_yaw * (a - t2 * R * m);
}

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
  const double w2 = silhouette_cosine2(m, trig);
  p.exists = wheel.dy > 0.0 && w2 > 0.0;
  if (!p.exists) return p;
  const double w = std::sqrt(w2);
  const double inverse_w = 1.0 / w;
  const double dm = (wheel.ddz - m * wheel.ddy) * inverse_dy;
  const double dw = -t2 * m * dm * inverse_w;
  p.x = -trig.sin_yaw * (a + R * m);
  p.y = silhouette_y(a, R, m, trig);
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

/// From the wheelset's axes, yawed but not rolled, into the rail-head frame.
template <class Real>
[[nodiscard]] PlaneVector<Real> in_rail_head(const Real& y, const Real& z, const WheelsetCentre& centre,
                                             const PoseTrigonometry& trig) noexcept {
  return {centre.y + trig.cos_roll * y - trig.sin_roll * z, centre.z + trig.sin_roll * y + trig.cos_roll * z};
}

/// A silhouette point rolled and moved into the rail-head frame: position, tangent, their derivatives as above.
[[nodiscard]] inline SilhouettePoint placed(const SilhouettePoint& p, const WheelsetCentre& centre,
                                            const PoseTrigonometry& trig) noexcept {
  const double c = trig.cos_roll;
  const double s = trig.sin_roll;
  const PlaneVector<double> at = in_rail_head(p.y, p.z, centre, trig);
  return {p.x,
          at.y,
          at.z,
          c * p.dy - s * p.dz,
          s * p.dy + c * p.dz,
          c * p.ty - s * p.tz,
          s * p.ty + c * p.tz,
          c * p.dty - s * p.dtz,
          s * p.dty + c * p.dtz,
          p.speed,
          p.exists};
}

}  // namespace railtab
