#pragma once

#include <cmath>

#include "railtab/runtime/contact/wheel_silhouette.hpp"
#include "railtab/runtime/profile/profile_curve.hpp"

namespace railtab {

// The equations of a contact pair [MontenegroCalcada2023, Eqs. 1-4], docs/theory/contact_search.md, sections 1 and 2.
//
// Yaw and roll enter through the wheel's silhouette (wheel_silhouette.hpp), with which contact in space is that of two
// plane curves: the silhouette p_w(s_wheel) with tangent t_w, and the rail p_r(s_rail) with tangent t_r = p_r'. With
// e = p_w - p_r, wheel point and rail point stand on a common normal where
//
//   f = t_r · e   = 0,    the wheel point lies on the rail point's normal,
//   g = t_w × t_r = 0,    the tangents are parallel.
//
// Derivatives by s_wheel (w) and s_rail (r), f and g being bilinear:
//
//   f_w = t_r · p_w',   f_r = t_r' · e - t_r · t_r,   g_w = t_w' × t_r,   g_r = t_w × t_r'.
//
// The penetration is d = t_r × e/|t_r| (Eq. 4). A wheel that touches the rail has e_y = 0 in place of f = 0.
//
// Real: double, an array of lanes (several points side by side), or a dual number. The order of the operations is part
// of the contract: results are compared bit by bit.

/// The silhouette at one wheel point. Its derivative p_w' is rate·direction.
template <class Real>
struct WheelTangent {
  PlaneVector<Real> tangent;  ///< t_w
  PlaneVector<Real> bend;     ///< t_w'
  Real rate;
  PlaneVector<Real> direction;
};

/// The rail at one point.
template <class Real>
struct RailTangent {
  PlaneVector<Real> tangent;  ///< t_r
  PlaneVector<Real> bend;     ///< t_r'
  /// The terms t_r,y² and t_r,z² of t_r·t_r, or their sum and zero: it is the same in all axes, and known early in
  /// those of the profile.
  PlaneVector<Real> squared;
};

/// Residuals f, g of a pair and their derivatives.
template <class Real>
struct PairEquations {
  Real f, g, f_w, f_r, g_w, g_r;

  [[nodiscard]] Real determinant() const noexcept { return f_w * g_r - f_r * g_w; }
  /// Newton's step along (wheel, rail), times the determinant. A kernel divides by it when it suits the processor.
  [[nodiscard]] PlaneVector<Real> scaled_step() const noexcept { return {f_r * g - g_r * f, g_w * f - f_w * g}; }
};

/// The common normal, e = p_w - p_r.
template <class Real>
[[nodiscard]] PairEquations<Real> common_normal(const WheelTangent<Real>& wheel, const RailTangent<Real>& rail,
                                                const PlaneVector<Real>& e) noexcept {
  return {dot(rail.tangent, e),
          cross(wheel.tangent, rail.tangent),
          wheel.rate * dot(rail.tangent, wheel.direction),
          dot(rail.bend, e) - rail.squared.y - rail.squared.z,
          cross(wheel.bend, rail.tangent),
          cross(wheel.tangent, rail.bend)};
}

/// A touching wheel: f = e_y.
template <class Real>
[[nodiscard]] PairEquations<Real> common_tangent(const WheelTangent<Real>& wheel, const RailTangent<Real>& rail,
                                                 const Real& e_y) noexcept {
  return {e_y,
          cross(wheel.tangent, rail.tangent),
          wheel.rate * wheel.direction.y,
          -rail.tangent.y,
          cross(wheel.bend, rail.tangent),
          cross(wheel.tangent, rail.bend)};
}

/// f = 0 alone: the foot on the rail of the normal through a wheel point that stays.
template <class Real>
struct FootOfNormal {
  Real squared, f, fall;  ///< t_r·t_r, f, -f_r

  FootOfNormal(const PlaneVector<Real>& tangent, const PlaneVector<Real>& bend, const PlaneVector<Real>& e)
      : squared(dot(tangent, tangent)), f(dot(tangent, e)), fall(squared - bend.y * e.y - bend.z * e.z) {}

  /// Newton's step to the foot, along the rail profile [m].
  [[nodiscard]] Real step() const { return f / fall; }
  /// Depth of the wheel point below the foot, to second order of the step that leads there [m].
  [[nodiscard]] Real depth(const PlaneVector<Real>& tangent, const PlaneVector<Real>& bend,
                           const PlaneVector<Real>& e) const {
    using std::sqrt;
    const Real length = sqrt(squared);
    const Real curvature = cross(tangent, bend) / (squared * length);
    return cross(tangent, e) / length - 0.5 * curvature * f * f / fall;
  }
};

[[nodiscard]] inline WheelTangent<double> wheel_tangent(const SilhouettePoint& S) noexcept {
  return {{S.ty, S.tz}, {S.dty, S.dtz}, 1.0, {S.dy, S.dz}};
}
[[nodiscard]] inline RailTangent<double> rail_tangent(const CurvePoint& C) noexcept {
  return {{C.dy, C.dz}, {C.ddy, C.ddz}, {C.dy * C.dy, C.dz * C.dz}};
}

}  // namespace railtab
