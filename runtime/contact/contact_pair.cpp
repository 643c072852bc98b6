#include "railtab/runtime/contact/contact_pair.hpp"

#include <limits>

#include "railtab/runtime/contact/common_normal.hpp"

namespace railtab {

namespace {

constexpr double largest_step = 1e-3;    // [m] keeps Newton on the piece of the profile that the start is for
constexpr double rounding_step = 1e-10;  // [m] a step this small that shrinks no more is rounding

struct Step {
  double wheel, rail;
  [[nodiscard]] double size() const noexcept { return std::abs(wheel) + std::abs(rail); }
};

// Newton's step, held to the largest step.
Step newton_step(const PairEquations<double>& equations, double determinant) noexcept {
  const PlaneVector<double> scaled = equations.scaled_step();
  Step step{scaled.y / determinant, scaled.z / determinant};
  const double size = step.size();
  if (size > largest_step) {
    step.wheel *= largest_step / size;
    step.rail *= largest_step / size;
  }
  return step;
}

// A wheel where it stands on its rail.
struct PlacedWheel {
  const WheelRailPair& pair;
  WheelsetCentre centre;
  const PoseTrigonometry& trig;
};

// Wheel and rail at a pair.
struct PointPair {
  CurvePoint W;
  CurvePoint C;
  SilhouettePoint S;

  PointPair(const PlacedWheel& wheel, const PairPosition& at) noexcept
      : W(wheel.pair.wheel().at(at.s_wheel)),
        C(wheel.pair.rail().at(at.s_rail)),
        S(placed(silhouette_point(W, wheel.pair.tape_circle_offset(), wheel.pair.nominal_radius(), wheel.trig),
                 wheel.centre, wheel.trig)) {}

  [[nodiscard]] PairEquations<double> common_normal() const noexcept {
    return railtab::common_normal(wheel_tangent(S), rail_tangent(C), {S.y - C.y, S.z - C.z});
  }
  [[nodiscard]] PairEquations<double> common_tangent() const noexcept {
    return railtab::common_tangent(wheel_tangent(S), rail_tangent(C), S.y - C.y);
  }
};

bool off_profile(const WheelRailPair& pair, const PairPosition& at) noexcept {
  return !pair.wheel().contains(at.s_wheel) || !pair.rail().contains(at.s_rail);
}

ContactPatch patch_of(const WheelRailPair& pair, const PairPosition& at, const PointPair& points) noexcept {
  const CurvePoint& W = points.W;
  const CurvePoint& C = points.C;
  const SilhouettePoint& S = points.S;
  ContactPatch p;
  p.s_wheel = at.s_wheel;
  p.s_rail = at.s_rail;
  p.y_rail = C.y;
  p.z_rail = C.z;
  p.y_wheel = W.y;
  p.z_wheel = W.z;
  p.x = S.x;
  p.angle = std::atan2(C.dz, C.dy);
  p.rolling_radius = pair.nominal_radius() + W.z;
  const double inverse_rail = 1.0 / std::sqrt(C.dy * C.dy + C.dz * C.dz);
  const double inverse_wheel = 1.0 / std::sqrt(W.dy * W.dy + W.dz * W.dz);
  p.penetration = ((S.z - C.z) * C.dy - (S.y - C.y) * C.dz) * inverse_rail;
  p.curv_wheel = (W.dz * W.ddy - W.dy * W.ddz) * inverse_wheel * inverse_wheel * inverse_wheel;
  p.curv_rail = (C.dy * C.ddz - C.dz * C.ddy) * inverse_rail * inverse_rail * inverse_rail;
  // The wheel's normal leans from the axle's radial direction by the slope of its own section alone.
  p.curv_rolling = W.dy * inverse_wheel / p.rolling_radius;
  p.concave = p.curv_wheel < 0.0;
  p.source = PatchSource::online_convex;
  return p;
}

}  // namespace

ContactPatch patch_of_pair(const WheelRailPair& pair, const WheelsetPose& pose, const PoseTrigonometry& trig,
                           const PairPosition& at) noexcept {
  return patch_of(pair, at, PointPair({pair, wheelset_centre(pair, pose), trig}, at));
}

namespace {

// Newton's method for two equations of a pair, from a starting pair.
// @param equations those of a PointPair
// @param finish called with points, equations, determinant and position at the solution; whether that is a minimum
template <class Equations, class Finish>
PairOutcome solve(const PlacedWheel& wheel, PairPosition at, const PairLimits& limits, const Equations& equations,
                  const Finish& finish) noexcept {
  PairOutcome end;
  double previous = largest_step;
  for (end.iterations = 1; end.iterations <= limits.iterations; ++end.iterations) {
    const PointPair points(wheel, at);
    if (!points.S.exists) return end;
    const PairEquations<double> e = equations(points);
    const double determinant = e.determinant();
    const Step step = newton_step(e, determinant);
    const double size = step.size();
    end.residual = size;
    if (size < limits.tolerance || (size < rounding_step && size >= 0.5 * previous)) {
      const bool minimum = finish(points, e, determinant, at);
      end.status = off_profile(wheel.pair, at) ? PairStatus::off_profile
                   : minimum                   ? PairStatus::converged
                                               : PairStatus::not_a_minimum;
      return end;
    }
    if (!(size < std::numeric_limits<double>::infinity())) return end;  // singular Jacobian
    previous = size;
    at.s_wheel += step.wheel;
    at.s_rail += step.rail;
  }
  end.iterations = limits.iterations;
  return end;
}

TouchPoint touch_of(const PointPair& points, const PairEquations<double>& e, double determinant,
                    const WheelsetCentre& centre, const PairPosition& at) noexcept {
  const CurvePoint& C = points.C;
  const SilhouettePoint& S = points.S;
  const double slope = C.dz / C.dy;
  // Rolling by d moves the wheel's point by d (-(S.z - centre.z), S.y - centre.y); the normal leans by the slope.
  const double droll = (centre.y - S.y) + slope * (centre.z - S.z);
  return {C.z - S.z, at.s_wheel, at.s_rail, slope, -e.g_r / determinant, e.g_w / determinant, droll};
}

WheelsetCentre touching_centre(const WheelRailPair& pair, const WheelsetPose& pose) noexcept {
  return wheelset_centre(pair, {pose.y, 0.0, pose.roll, pose.yaw});
}

}  // namespace

RefinedPair refine_pair(const WheelRailPair& pair, const WheelsetPose& pose, const PoseTrigonometry& trig,
                        const PairPosition& start, const PairLimits& limits) noexcept {
  RefinedPair result;
  static_cast<PairOutcome&>(result) = solve(
      {pair, wheelset_centre(pair, pose), trig}, start, limits,
      [](const PointPair& points) { return points.common_normal(); },
      [&](const PointPair& points, const PairEquations<double>& e, double determinant, const PairPosition& at) {
        result.patch = patch_of(pair, at, points);
        // determinant = speed |t_r|^3 |t_w|^2 (1 - kappa_r d)(kappa_r/(1 - kappa_r d) + kappa_w).
        return determinant > 0.0 && e.f_r < 0.0 && points.S.speed > 0.0;
      });
  return result;
}

TouchPoint touch_of_pair(const WheelRailPair& pair, const WheelsetPose& pose, const PoseTrigonometry& trig,
                         const PairPosition& at) noexcept {
  const WheelsetCentre centre = touching_centre(pair, pose);
  const PointPair points({pair, centre, trig}, at);
  const PairEquations<double> e = points.common_tangent();
  return touch_of(points, e, e.determinant(), centre, at);
}

RefinedTouch refine_touch(const WheelRailPair& pair, const WheelsetPose& pose, const PoseTrigonometry& trig,
                          const PairPosition& start, const PairLimits& limits) noexcept {
  const WheelsetCentre centre = touching_centre(pair, pose);
  RefinedTouch result;
  static_cast<PairOutcome&>(result) = solve(
      {pair, centre, trig}, start, limits, [](const PointPair& points) { return points.common_tangent(); },
      [&](const PointPair& points, const PairEquations<double>& e, double determinant, const PairPosition& at) {
        result.touch = touch_of(points, e, determinant, centre, at);
        // determinant = t_r,y dg/ds_wheel along the gap, g the gap's slope but for positive factors.
        return determinant > 0.0 && points.C.dy > 0.0 && points.S.speed > 0.0;
      });
  return result;
}

}  // namespace railtab
