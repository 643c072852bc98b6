#include "railtab/runtime/contact/contact_pair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "contact_test_pairs.hpp"

namespace railtab {
namespace {

using contact_test::cone_on_circle;
using contact_test::s1002_on_60e1;

// The wheel's surface itself: a point at arc length s and angle theta round the axle, in the rail-head frame.
struct SurfacePoint {
  double x, y, z;
};
SurfacePoint surface(const WheelRailPair& pair, const WheelsetPose& pose, double s, double theta) {
  const CurvePoint w = pair.wheel().at(s);
  const double a = pair.tape_circle_offset() + w.y;
  const double R = pair.nominal_radius() + w.z;
  const double px = R * std::sin(theta);
  const double pz = R * std::cos(theta);
  const double x = std::cos(pose.yaw) * px - std::sin(pose.yaw) * a;
  const double y = std::sin(pose.yaw) * px + std::cos(pose.yaw) * a;
  const WheelsetCentre c = wheelset_centre(pair, pose);
  return {x, c.y + std::cos(pose.roll) * y - std::sin(pose.roll) * pz,
          c.z + std::sin(pose.roll) * y + std::cos(pose.roll) * pz};
}

SilhouettePoint silhouette(const WheelRailPair& pair, const WheelsetPose& pose, double s) {
  const PoseTrigonometry trig(pose);
  return placed(silhouette_point(pair.wheel().at(s), pair.tape_circle_offset(), pair.nominal_radius(), trig),
                wheelset_centre(pair, pose), trig);
}

TEST(Silhouette, LiesOnTheWheelWhereTheNormalHasNoLongitudinalPart) {
  const WheelRailPair& pair = s1002_on_60e1();
  const WheelsetPose pose{0.004, 0.0, 0.009, 0.03};
  for (double y = -0.042; y < 0.05; y += 0.0017) {
    const double s = pair.wheel().s_at_y(y);
    const CurvePoint w = pair.wheel().at(s);
    const SilhouettePoint S = silhouette(pair, pose, s);
    ASSERT_TRUE(S.exists);
    const double theta = std::asin(-std::tan(pose.yaw) * w.dz / w.dy);
    const SurfacePoint p = surface(pair, pose, s, theta);
    EXPECT_NEAR(S.x, p.x, 1e-15);
    EXPECT_NEAR(S.y, p.y, 1e-15);
    EXPECT_NEAR(S.z, p.z, 1e-15);
    // The silhouette point is the lowest of its neighbours along x at the same y: move along the surface's tangents.
    const double h = 1e-5;
    const SurfacePoint t = surface(pair, pose, s, theta + h);
    const SurfacePoint u = surface(pair, pose, s, theta - h);
    const double tangent_y = t.y - u.y;
    const double tangent_z = t.z - u.z;
    // Surface tangent along theta has its (y, z) part parallel to the silhouette's tangent.
    EXPECT_NEAR(tangent_y * S.tz - tangent_z * S.ty, 0.0, 1e-10 * h);
  }
}

TEST(Silhouette, DerivativesAgreeWithDifferences) {
  const WheelRailPair& pair = s1002_on_60e1();
  const WheelsetPose pose{0.004, 0.0, -0.007, 0.03};
  const double h = 1e-6;
  for (const double y : {-0.0445, -0.039, -0.0365, -0.0321, -0.021, -0.003, 0.0131, 0.0402}) {
    const double s = pair.wheel().s_at_y(y);
    const SilhouettePoint S = silhouette(pair, pose, s);
    const SilhouettePoint b = silhouette(pair, pose, s + h);
    const SilhouettePoint a = silhouette(pair, pose, s - h);
    EXPECT_NEAR(S.dy, (b.y - a.y) / (2 * h), 2e-7) << y;
    EXPECT_NEAR(S.dz, (b.z - a.z) / (2 * h), 2e-7) << y;
    EXPECT_NEAR(S.dty, (b.ty - a.ty) / (2 * h), 1e-5) << y;
    EXPECT_NEAR(S.dtz, (b.tz - a.tz) / (2 * h), 1e-5) << y;
    EXPECT_NEAR(S.dy * S.tz - S.dz * S.ty, 0.0, 1e-15) << y;
  }
}

TEST(Silhouette, DoesNotExistOnAFlankTooSteepForTheYaw) {
  const PoseTrigonometry trig({0.0, 0.0, 0.0, 0.03});
  const double steepest = 1.0 / std::tan(0.03);
  EXPECT_TRUE(silhouette_point({0, 0, 1.0, 0.99 * steepest, 0, 0}, 0.75, 0.46, trig).exists);
  EXPECT_FALSE(silhouette_point({0, 0, 1.0, 1.01 * steepest, 0, 0}, 0.75, 0.46, trig).exists);
  EXPECT_FALSE(silhouette_point({0, 0, -1.0, 0.0, 0, 0}, 0.75, 0.46, trig).exists);
}

// A line at angle -(atan(slope)) + roll over a circle: the contact is where the circle's tangent is the line's.
TEST(RefinePair, ConeOnCircleInClosedForm) {
  const double slope = 0.1;
  const double r = 0.05;
  const WheelRailPair pair = cone_on_circle(slope, r);
  for (const double roll : {-0.01, 0.0, 0.01}) {
    const WheelsetPose pose{0.003, 1.2e-3, roll, 0.0};
    const WheelsetCentre c = wheelset_centre(pair, pose);
    const double angle = roll - std::atan(slope);
    // Distance of the circle's centre (0, r) from the cone's line through the tape circle's lowest point.
    const double y0 = c.y + std::cos(roll) * pair.tape_circle_offset() - std::sin(roll) * pair.nominal_radius();
    const double z0 = c.z + std::sin(roll) * pair.tape_circle_offset() + std::cos(roll) * pair.nominal_radius();
    const double distance = -(0.0 - y0) * std::sin(angle) + (r - z0) * std::cos(angle);
    const RefinedPair result =
        refine_pair(pair, pose, PoseTrigonometry(pose), {pair.wheel().s_at_y(0.0), pair.rail().s_at_y(0.0)}, {30});
    ASSERT_EQ(result.status, PairStatus::converged);
    const ContactPatch& p = result.patch;
    EXPECT_NEAR(p.angle, angle, 1e-12);
    EXPECT_NEAR(p.penetration, r - distance, 1e-14);
    EXPECT_NEAR(p.y_rail, r * std::sin(angle), 2e-12);  // the cubic's tangent has an error of third order
    EXPECT_NEAR(p.curv_rail, 1.0 / r, 1e-6 / r);
    EXPECT_NEAR(p.curv_wheel, 0.0, 1e-10);
    EXPECT_NEAR(p.rolling_radius, pair.nominal_radius() - slope * p.y_wheel, 1e-15);
    EXPECT_NEAR(p.curv_rolling, std::cos(std::atan(slope)) / p.rolling_radius, 1e-12);
    EXPECT_EQ(p.x, 0.0);
  }
}

// The normal of the patch is the surface's: its longitudinal part vanishes and its direction is the contact angle.
// curv_rolling is checked by Meusnier's theorem: the parallel circle of radius r seen under the normal's lean.
TEST(RefinePair, NormalIsThatOfTheWheelSurfaceUnderYawAndRoll) {
  const WheelRailPair& pair = s1002_on_60e1();
  const WheelsetPose pose{0.0075, -3.0e-3, -0.006, 0.018};
  const double s0 = pair.wheel().s_at_y(-0.0408);
  const RefinedPair result = refine_pair(pair, pose, PoseTrigonometry(pose), {s0, pair.rail().s_at_y(-0.0415)}, {30});
  ASSERT_EQ(result.status, PairStatus::converged);
  const ContactPatch& p = result.patch;
  const CurvePoint w = pair.wheel().at(p.s_wheel);
  const double theta = std::asin(-std::tan(pose.yaw) * w.dz / w.dy);
  const double h = 1e-6;
  const auto difference = [&](double ds, double dt) {
    const SurfacePoint a = surface(pair, pose, p.s_wheel - ds, theta - dt);
    const SurfacePoint b = surface(pair, pose, p.s_wheel + ds, theta + dt);
    return std::array<double, 3>{(b.x - a.x) / (2 * h), (b.y - a.y) / (2 * h), (b.z - a.z) / (2 * h)};
  };
  const std::array<double, 3> n{0.0, -std::sin(p.angle), std::cos(p.angle)};
  for (const auto& t : {difference(h, 0.0), difference(0.0, h)}) {
    EXPECT_NEAR(t[0] * n[0] + t[1] * n[1] + t[2] * n[2], 0.0, 1e-8);
  }
  const auto second = [&](double step) {
    const SurfacePoint a = surface(pair, pose, p.s_wheel, theta - step);
    const SurfacePoint m = surface(pair, pose, p.s_wheel, theta);
    const SurfacePoint b = surface(pair, pose, p.s_wheel, theta + step);
    const double normal = (a.y - 2 * m.y + b.y) * n[1] + (a.z - 2 * m.z + b.z) * n[2];
    return -normal / (step * step) / (p.rolling_radius * p.rolling_radius);
  };
  EXPECT_NEAR(second(1e-3), p.curv_rolling, 1e-5 * p.curv_rolling);
}

TEST(RefinePair, ConvergesQuadraticallyNearTheContact) {
  const WheelRailPair& pair = s1002_on_60e1();
  const WheelsetPose pose{0.003, 0.3e-3, 0.0, 0.01};
  const PoseTrigonometry trig(pose);
  const RefinedPair exact =
      refine_pair(pair, pose, trig, {pair.wheel().s_at_y(-0.013), pair.rail().s_at_y(-0.0205)}, {30});
  ASSERT_EQ(exact.status, PairStatus::converged);
  const auto iterations = [&](double off) {
    const RefinedPair r = refine_pair(pair, pose, trig, {exact.patch.s_wheel + off, exact.patch.s_rail - off});
    EXPECT_EQ(r.status, PairStatus::converged);
    EXPECT_NEAR(r.patch.s_wheel, exact.patch.s_wheel, 1e-12);
    EXPECT_NEAR(r.patch.penetration, exact.patch.penetration, 1e-16);
    return r.iterations;
  };
  EXPECT_LE(iterations(1e-6), 3);
  EXPECT_LE(iterations(1e-4), 5);
}

TEST(RefinePair, PenetrationErrorIsOfSecondOrderInTheTolerance) {
  const WheelRailPair& pair = s1002_on_60e1();
  const WheelsetPose pose{0.0, 0.25e-3, 0.0, 0.0};
  const PoseTrigonometry trig(pose);
  const double s_wheel = pair.wheel().s_at_y(0.0032);
  const double s_rail = pair.rail().s_at_y(-0.0073);
  const RefinedPair exact = refine_pair(pair, pose, trig, {s_wheel, s_rail}, {30});
  const RefinedPair loose = refine_pair(pair, pose, trig, {exact.patch.s_wheel + 4e-6, exact.patch.s_rail}, {30, 1e-5});
  ASSERT_EQ(loose.status, PairStatus::converged);
  EXPECT_EQ(loose.iterations, 1);
  EXPECT_NEAR(loose.patch.penetration, exact.patch.penetration, 1e-9);
}

TEST(RefinePair, SaysThatAMaximumIsNotAContact) {
  // Between the two minima of S1002 on 60E1 near y = 4.85 mm the distance has a maximum.
  const WheelRailPair& pair = s1002_on_60e1();
  const WheelsetPose pose{0.00485, 0.0, -0.00034, 0.0};
  const PoseTrigonometry trig(pose);
  int maxima = 0;
  for (double y = -0.027; y < -0.019; y += 1e-4) {
    const double s = pair.wheel().s_at_y(y);
    const SilhouettePoint S = silhouette(pair, pose, s);
    const RefinedPair r = refine_pair(pair, pose, trig, {s, pair.rail().s_at_y(S.y)}, {30});
    if (r.status != PairStatus::not_a_minimum) continue;
    ++maxima;
    // Wheel points to both sides are deeper.
    const PoseTrigonometry t(pose);
    for (const double ds : {-3e-4, 3e-4}) {
      const SilhouettePoint beside = silhouette(pair, pose, r.patch.s_wheel + ds);
      double nearest = std::numeric_limits<double>::infinity();
      for (double dv = -1e-3; dv < 1e-3; dv += 1e-7) {
        const CurvePoint C = pair.rail().at(r.patch.s_rail + ds + dv);
        nearest = std::min(nearest, std::hypot(beside.y - C.y, beside.z - C.z));
      }
      EXPECT_GT((beside.z > pair.rail().at(pair.rail().s_at_y(beside.y)).z ? nearest : -nearest), r.patch.penetration);
    }
  }
  EXPECT_GT(maxima, 0);
}

TEST(RefinePair, SaysThatAPairBeyondTheEndIsOffTheProfile) {
  const WheelRailPair pair = cone_on_circle(0.05, 0.05);
  // The wheel's cone ends 0.03 m inside its tape circle; shifted outwards it misses the rail's crown.
  const WheelsetPose pose{0.06, 0.0, 0.0, 0.0};
  const RefinedPair r =
      refine_pair(pair, pose, PoseTrigonometry(pose), {pair.wheel().s_begin(), pair.rail().s_at_y(0.0)}, {100});
  EXPECT_EQ(r.status, PairStatus::off_profile);
}

// From starts up to 20 µm off, on both sides and across joints of the profiles, what Newton to rounding finds.
TEST(PolishPair, IsThePairOfRefinePair) {
  const WheelRailPair& pair = s1002_on_60e1();
  int compared = 0;
  for (const double y : {-0.003, 0.0, 0.002, 0.0065}) {
    const WheelsetPose pose{y, 0.0, 0.002, 0.012};
    const PoseTrigonometry trig(pose);
    for (double at = -0.03; at < 0.02; at += 0.0011) {
      WheelsetPose lowered = pose;
      const RefinedTouch touch =
          refine_touch(pair, pose, trig, {pair.wheel().s_at_y(at), pair.rail().s_at_y(at)}, {40});
      if (touch.status != PairStatus::converged) continue;
      lowered.z = touch.touch.z_touch + 1e-4;
      const RefinedPair r = refine_pair(pair, lowered, trig, {touch.touch.s_wheel, touch.touch.s_rail});
      if (r.status != PairStatus::converged) continue;
      for (const double off : {-20e-6, -3e-6, 0.0, 5e-6, 20e-6}) {
        ContactPatch p;
        ASSERT_EQ(
            polish_pair(pair, wheelset_centre(pair, lowered), trig, {r.patch.s_wheel + off, r.patch.s_rail - off}, p),
            PairStatus::converged);
        // The second order of a step of 20 µm, times the change of curvature over the relative curvature.
        EXPECT_NEAR(p.s_wheel, r.patch.s_wheel, 1e-6);
        EXPECT_NEAR(p.s_rail, r.patch.s_rail, 1e-6);
        EXPECT_NEAR(p.penetration, r.patch.penetration, 1e-11);
        EXPECT_NEAR(p.angle, r.patch.angle, 1e-4);
        EXPECT_NEAR(p.x, r.patch.x, 1e-6);
        if (off != 0.0) continue;
        EXPECT_NEAR(p.curv_wheel, r.patch.curv_wheel, 1e-9);
        EXPECT_NEAR(p.curv_rail, r.patch.curv_rail, 1e-9);
        EXPECT_NEAR(p.curv_rolling, r.patch.curv_rolling, 1e-12);
        EXPECT_NEAR(p.rolling_radius, r.patch.rolling_radius, 1e-12);
        EXPECT_NEAR(p.angle, r.patch.angle, 1e-12);
        EXPECT_EQ(p.concave, r.patch.concave);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 50);
}

TEST(SineCosine, AreTheLibrarysToRounding) {
  for (double x = -0.4; x <= 0.4; x += 1.7e-4) {
    const SineCosine series(x);
    EXPECT_NEAR(series.sine, std::sin(x), 2.3e-16 * std::abs(x) + 1e-20);  // one unit in the last place
    EXPECT_NEAR(series.cosine, std::cos(x), 2.3e-16);
  }
}

TEST(RefineTouch, IsTheContactOfZeroPenetration) {
  const WheelRailPair& pair = s1002_on_60e1();
  const WheelsetPose pose{0.007, 0.0, -0.005, 0.02};
  const PoseTrigonometry trig(pose);
  const RefinedTouch touch =
      refine_touch(pair, pose, trig, {pair.wheel().s_at_y(-0.0405), pair.rail().s_at_y(-0.0415)}, {40});
  ASSERT_EQ(touch.status, PairStatus::converged);
  WheelsetPose at_touch = pose;
  at_touch.z = touch.touch.z_touch;
  const RefinedPair r = refine_pair(pair, at_touch, trig, {touch.touch.s_wheel, touch.touch.s_rail});
  ASSERT_EQ(r.status, PairStatus::converged);
  EXPECT_NEAR(r.patch.penetration, 0.0, 1e-15);
  EXPECT_NEAR(r.patch.s_wheel, touch.touch.s_wheel, 1e-12);
  EXPECT_NEAR(std::tan(r.patch.angle), touch.touch.z_touch_dy, 1e-12);
}

}  // namespace
}  // namespace railtab
