#include "railtab/runtime/contact/contact_pair.hpp"

#include <limits>

namespace railtab {

namespace {

constexpr double largest_step = 1e-3;    // [m] keeps Newton on the piece of the profile that the start is for
constexpr double rounding_step = 1e-10;  // [m] a step this small that shrinks no more is rounding

struct Step {
  double wheel, rail;
  [[nodiscard]] double size() const noexcept { return std::abs(wheel) + std::abs(rail); }
};

// Solution of [a b; c d] step = -(f, g), held to the largest step.
Step newton_step(double a, double b, double c, double d, double det, double f, double g) noexcept {
  Step step{(b * g - d * f) / det, (c * f - a * g) / det};
  const double size = step.size();
  if (size > largest_step) {
    step.wheel *= largest_step / size;
    step.rail *= largest_step / size;
  }
  return step;
}

// Eqs. 1-4 at a pair: t_r·d_wr (f) and t_w x t_r (g), with their derivatives by (s_wheel, s_rail).
struct CommonNormal {
  CurvePoint C;
  SilhouettePoint S;
  double f, g, f_w, f_r, g_w, g_r, det;

  CommonNormal(const CurvePoint& wheel, const CurvePoint& rail, double axial, double radius,
               const WheelsetCentre& centre, const PoseTrigonometry& trig) noexcept
      : C(rail), S(placed(silhouette_point(wheel, axial, radius, trig), centre, trig)) {
    const double ey = S.y - C.y;
    const double ez = S.z - C.z;
    f = C.dy * ey + C.dz * ez;
    g = S.ty * C.dz - S.tz * C.dy;
    f_w = C.dy * S.dy + C.dz * S.dz;
    f_r = C.ddy * ey + C.ddz * ez - C.dy * C.dy - C.dz * C.dz;
    g_w = S.dty * C.dz - S.dtz * C.dy;
    g_r = S.ty * C.ddz - S.tz * C.ddy;
    det = f_w * g_r - f_r * g_w;
  }

  [[nodiscard]] Step newton_step() const noexcept { return railtab::newton_step(f_w, f_r, g_w, g_r, det, f, g); }
  // At the solution det = speed |t_r|^3 |t_w|^2 (1 - kappa_r d)(kappa_r/(1 - kappa_r d) + kappa_w).
  [[nodiscard]] bool is_minimum() const noexcept { return det > 0.0 && f_r < 0.0 && S.speed > 0.0; }
};

bool off_profile(const WheelRailPair& pair, double s_wheel, double s_rail) noexcept {
  return !pair.wheel().contains(s_wheel) || !pair.rail().contains(s_rail);
}

void set_patch(const WheelRailPair& pair, double s_wheel, double s_rail, const CurvePoint& wheel,
               const SilhouettePoint& S, const CurvePoint& C, double angle, ContactPatch& p) noexcept {
  p.s_wheel = s_wheel;
  p.s_rail = s_rail;
  p.y_rail = C.y;
  p.z_rail = C.z;
  p.y_wheel = wheel.y;
  p.z_wheel = wheel.z;
  p.x = S.x;
  p.angle = angle;
  p.rolling_radius = pair.nominal_radius() + wheel.z;
  const double inverse_rail = 1.0 / std::sqrt(C.dy * C.dy + C.dz * C.dz);
  const double inverse_wheel = 1.0 / std::sqrt(wheel.dy * wheel.dy + wheel.dz * wheel.dz);
  p.penetration = ((S.z - C.z) * C.dy - (S.y - C.y) * C.dz) * inverse_rail;
  p.curv_wheel = (wheel.dz * wheel.ddy - wheel.dy * wheel.ddz) * inverse_wheel * inverse_wheel * inverse_wheel;
  p.curv_rail = (C.dy * C.ddz - C.dz * C.ddy) * inverse_rail * inverse_rail * inverse_rail;
  // The wheel's normal leans from the axle's radial direction by the slope of its own section alone.
  p.curv_rolling = wheel.dy * inverse_wheel / p.rolling_radius;
  p.concave = p.curv_wheel < 0.0;
  p.source = PatchSource::online_convex;
}

ContactPatch patch_of(const WheelRailPair& pair, double s_wheel, double s_rail, const CurvePoint& wheel,
                      const SilhouettePoint& S, const CurvePoint& C) noexcept {
  ContactPatch p;
  set_patch(pair, s_wheel, s_rail, wheel, S, C, std::atan2(C.dz, C.dy), p);
  return p;
}

}  // namespace

ContactPatch patch_of_pair(const WheelRailPair& pair, const WheelsetPose& pose, const PoseTrigonometry& trig,
                           double s_wheel, double s_rail) noexcept {
  const CurvePoint wheel = pair.wheel().at(s_wheel);
  const SilhouettePoint S = silhouette_point(wheel, pair.tape_circle_offset(), pair.nominal_radius(), trig);
  return patch_of(pair, s_wheel, s_rail, wheel, placed(S, wheelset_centre(pair, pose), trig), pair.rail().at(s_rail));
}

RefinedPair refine_pair(const WheelRailPair& pair, const WheelsetPose& pose, const PoseTrigonometry& trig,
                        double s_wheel, double s_rail, int max_iterations, double tolerance) noexcept {
  const WheelsetCentre centre = wheelset_centre(pair, pose);
  const double axial = pair.tape_circle_offset();
  const double radius = pair.nominal_radius();
  RefinedPair result;
  double previous = largest_step;
  for (result.iterations = 1; result.iterations <= max_iterations; ++result.iterations) {
    const CurvePoint wheel = pair.wheel().at(s_wheel);
    const CommonNormal at(wheel, pair.rail().at(s_rail), axial, radius, centre, trig);
    if (!at.S.exists) return result;
    const Step step = at.newton_step();
    const double size = step.size();
    result.residual = size;
    if (size < tolerance || (size < rounding_step && size >= 0.5 * previous)) {
      result.patch = patch_of(pair, s_wheel, s_rail, wheel, at.S, at.C);
      result.status = off_profile(pair, s_wheel, s_rail) ? PairStatus::off_profile
                      : at.is_minimum()                  ? PairStatus::converged
                                                         : PairStatus::not_a_minimum;
      return result;
    }
    if (!(size < std::numeric_limits<double>::infinity())) return result;  // singular Jacobian
    previous = size;
    s_wheel += step.wheel;
    s_rail += step.rail;
  }
  result.iterations = max_iterations;
  return result;
}

namespace {

// Equations y_wheel = y_rail (f) and t_w x t_r = 0 (g) of a touching wheel, with their derivatives.
struct TouchEquations {
  CurvePoint C;
  SilhouettePoint S;
  double f, g, f_w, f_r, g_w, g_r, det;

  TouchEquations(const WheelRailPair& pair, const WheelsetCentre& centre, const PoseTrigonometry& trig, double s_wheel,
                 double s_rail) noexcept
      : C(pair.rail().at(s_rail)),
        S(placed(silhouette_point(pair.wheel().at(s_wheel), pair.tape_circle_offset(), pair.nominal_radius(), trig),
                 centre, trig)),
        f(S.y - C.y),
        g(S.ty * C.dz - S.tz * C.dy),
        f_w(S.dy),
        f_r(-C.dy),
        g_w(S.dty * C.dz - S.dtz * C.dy),
        g_r(S.ty * C.ddz - S.tz * C.ddy),
        det(f_w * g_r - f_r * g_w) {}

  [[nodiscard]] TouchPoint touch(const WheelsetCentre& centre, double s_wheel, double s_rail) const noexcept {
    const double slope = C.dz / C.dy;
    // Rolling by d moves the wheel's point by d (-(S.z - centre.z), S.y - centre.y); the normal leans by the slope.
    const double droll = (centre.y - S.y) + slope * (centre.z - S.z);
    return {C.z - S.z, s_wheel, s_rail, slope, -g_r / det, g_w / det, droll};
  }
};

}  // namespace

TouchPoint touch_of_pair(const WheelRailPair& pair, const WheelsetPose& pose, const PoseTrigonometry& trig,
                         double s_wheel, double s_rail) noexcept {
  const WheelsetCentre centre = wheelset_centre(pair, {pose.y, 0.0, pose.roll, pose.yaw});
  return TouchEquations(pair, centre, trig, s_wheel, s_rail).touch(centre, s_wheel, s_rail);
}

RefinedTouch refine_touch(const WheelRailPair& pair, const WheelsetPose& pose, const PoseTrigonometry& trig,
                          double s_wheel, double s_rail, int max_iterations, double tolerance) noexcept {
  const WheelsetCentre centre = wheelset_centre(pair, {pose.y, 0.0, pose.roll, pose.yaw});
  RefinedTouch result;
  double previous = largest_step;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const TouchEquations e(pair, centre, trig, s_wheel, s_rail);
    if (!e.S.exists) return result;
    const Step step = newton_step(e.f_w, e.f_r, e.g_w, e.g_r, e.det, e.f, e.g);
    const double size = step.size();
    if (size < tolerance || (size < rounding_step && size >= 0.5 * previous)) {
      result.touch = e.touch(centre, s_wheel, s_rail);
      // det = C.dy dg/ds_wheel along the gap, g the gap's slope but for positive factors: a minimum where positive.
      const bool minimum = e.det > 0.0 && e.C.dy > 0.0 && e.S.speed > 0.0;
      result.status = off_profile(pair, s_wheel, s_rail) ? PairStatus::off_profile
                      : minimum                          ? PairStatus::converged
                                                         : PairStatus::not_a_minimum;
      return result;
    }
    if (!(size < std::numeric_limits<double>::infinity())) return result;
    previous = size;
    s_wheel += step.wheel;
    s_rail += step.rail;
  }
  return result;
}

}  // namespace railtab
