#include "railtab/runtime/contact/contact_search_walk.hpp"

#include <algorithm>
#include <cmath>

#include "railtab/runtime/contact/common_normal.hpp"

namespace railtab {

GapSlope GapWalk::at(const SilhouettePoint& S, double s_wheel, double s_rail) const noexcept {
  constexpr int most_steps = 12;
  constexpr double largest_step = 3e-3;  // [m]
  // The last step is applied to the tangent to first order; its error is the square of this over the rail's radius.
  constexpr double last_step = 3e-6;
  GapSlope result;
  result.s_wheel = s_wheel;
  if (!S.exists) return result;
  const WheelTangent<double> wheel = wheel_tangent(S);
  for (int i = 0; i < most_steps; ++i) {
    const CurvePoint C = pair_.rail().at(s_rail);
    const RailTangent<double> rail = rail_tangent(C);
    const PlaneVector<double> e{S.y - C.y, S.z - C.z};
    double residual;  // zero at the opposite point, falling along the rail at `fall`
    double fall;
    double residual_ds;  // along the wheel
    if (opposite_ == Opposite::nearest) {
      const double length2 = dot(rail.tangent, rail.tangent);
      residual = dot(rail.tangent, e);
      // Beyond the centre of curvature Newton would run from the nearest point.
      fall = std::max(length2 - dot(rail.bend, e), 0.2 * length2);
      residual_ds = dot(rail.tangent, {S.dy, S.dz});
    } else {
      residual = e.y;
      fall = std::max(C.dy, 1e-3);
      residual_ds = S.dy;
    }
    const double step = std::clamp(residual / fall, -largest_step, largest_step);
    s_rail += step;
    if (!(std::abs(step) < last_step)) continue;
    const PlaneVector<double> tangent{C.dy + step * C.ddy, C.dz + step * C.ddz};
    result.s_rail = s_rail;
    result.s_rail_ds = residual_ds / fall;
    result.slope = cross(wheel.tangent, tangent);
    result.slope_ds = cross(wheel.bend, tangent) + cross(wheel.tangent, rail.bend) * result.s_rail_ds;
    result.exists = pair_.rail().contains(s_rail) && S.speed > 0.0;
    return result;
  }
  return result;
}

GapBracket GapWalk::bracket(const GapSlope& left, const GapSlope& right) const noexcept {
  if (!left.exists || !right.exists) return {};
  if (left.slope < 0.0 && right.slope >= 0.0) return {left, right, true};
  const double sign = left.slope >= 0.0 ? 1.0 : -1.0;
  const bool dips = sign * right.slope > 0.0 && sign * left.slope_ds < 0.0 && sign * right.slope_ds > 0.0;
  if (!dips) return {};
  GapSlope a = left;
  GapSlope b = right;
  for (int i = 0; i < 8; ++i) {
    // Where the end tangents meet: at once the kink of a slope that bends at a profile joint, and a bound of a smooth
    // one. Where the slope is both, bent before the kink, it goes beyond that bound by a part of what the tangents
    // change over the width.
    constexpr double bend = 0.1;
    const double width = b.s_wheel - a.s_wheel;
    const double x = (b.slope - a.slope - b.slope_ds * width) / (a.slope_ds - b.slope_ds);
    const double reserve = bend * width * (std::abs(a.slope_ds) + std::abs(b.slope_ds));
    if (sign * (a.slope + x * a.slope_ds) >= reserve) return {};
    const double t = std::clamp(x / width, 0.02, 0.98);
    const double s = a.s_wheel + t * width;
    const GapSlope c = at(wheel_point(s), s, a.s_rail + t * (b.s_rail - a.s_rail));
    if (!c.exists) return {};
    if (sign * c.slope < 0.0) return sign > 0.0 ? GapBracket{c, right, true} : GapBracket{left, c, true};
    (sign * c.slope_ds < 0.0 ? a : b) = c;
  }
  return {};
}

GapSlope GapWalk::solve(GapBracket bracket) const noexcept {
  GapSlope& a = bracket.left;
  GapSlope& b = bracket.right;
  double fa = a.slope;
  double fb = b.slope;
  GapSlope c = b;
  int side = 0;
  for (int i = 0; i < 100 && b.s_wheel - a.s_wheel > 1e-14; ++i) {
    // A bisection every fourth time bounds the number of steps where the slope jumps (profile joints, cusps).
    const double t = i % 4 == 3 ? 0.5 : fa / (fa - fb);
    const double s = a.s_wheel + t * (b.s_wheel - a.s_wheel);
    c = at(wheel_point(s), s, a.s_rail + t * (b.s_rail - a.s_rail));
    if (!c.exists) return c;
    if (c.slope < 0.0) {
      a = c;
      fa = c.slope;
      if (side == -1) fb *= 0.5;
      side = -1;
    } else {
      b = c;
      fb = c.slope;
      if (side == 1) fa *= 0.5;
      side = 1;
    }
  }
  // Once more from the foot found: to rounding.
  return at(wheel_point(c.s_wheel), c.s_wheel, c.s_rail);
}

}  // namespace railtab
