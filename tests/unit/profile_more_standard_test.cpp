// CHN60, the LMA-type wheel and the stand-ins against the numbers that define them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/runtime/profile/profile_curve.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"

namespace railtab {
namespace {

constexpr double mm = 1e-3;
constexpr double degree = std::numbers::pi / 180.0;

ProfileCurve wheel(const char* name) { return ProfileCurve(standard_profile(ProfileKind::wheel, name, 0.0)); }
ProfileCurve upright(const char* name) { return ProfileCurve(standard_profile(ProfileKind::rail, name, 0.0)); }

CurvePoint at_y(const ProfileCurve& curve, double y) { return curve.at(curve.s_at_y(y)); }
double radius_at(const ProfileCurve& curve, double y) { return 1.0 / at_y(curve, y).curvature(); }
double tangent_angle(const CurvePoint& p) { return std::atan2(-p.dz, p.dy); }

TEST(RailCHN60, HasTheRadiiAndDimensionsOfItsFit) {
  const ProfileCurve rail = upright("CHN60");
  for (const double side : {-1.0, 1.0}) {
    EXPECT_NEAR(radius_at(rail, side * 9.9 * mm), 300 * mm, 0.05 * mm);
    EXPECT_NEAR(radius_at(rail, side * 10.2 * mm), 80 * mm, 0.02 * mm);
    EXPECT_NEAR(radius_at(rail, side * 25.2 * mm), 80 * mm, 0.02 * mm);
    EXPECT_NEAR(radius_at(rail, side * 25.5 * mm), 13 * mm, 0.002 * mm);
    // Half width 34.684 + 0.05 z of the fitted flank, whose top is at (35.393, 14.19).
    EXPECT_NEAR(at_y(rail, side * 35.393 * mm).z, 14.19 * mm, 0.02 * mm);
    EXPECT_NEAR(at_y(rail, side * (34.684 + 0.05 * 30.0) * mm).z, 30.0 * mm, 0.02 * mm);
  }
}

TEST(RailJIS60StandIn, HasTheRadiiAndHeadWidthThatItIsMadeFor) {
  const ProfileCurve rail = upright("JIS60-stand-in");
  for (const double side : {-1.0, 1.0}) {
    EXPECT_NEAR(radius_at(rail, side * 9.8 * mm), 600 * mm, 0.1 * mm);
    EXPECT_NEAR(radius_at(rail, side * 16.0 * mm), 50 * mm, 0.01 * mm);
    EXPECT_NEAR(radius_at(rail, side * 25.0 * mm), 13 * mm, 0.002 * mm);
    EXPECT_NEAR(at_y(rail, side * 32.5 * mm).z, 14.0 * mm, 0.02 * mm);  // 0.001 mm of width on the flank 1:20
  }
}

TEST(WheelLMAType, HasTheRadiiAndCentresOfItsFit) {
  const ProfileCurve curve = wheel("LMA-type");
  EXPECT_NEAR(at_y(curve, 0.0).z, 0.0, 1e-12);
  struct Arc {
    double y, radius, centre_y, centre_z;  // mm; radius positive where convex, centre as fitted with z down
  };
  for (const Arc& a :
       {Arc{-60.0, 12, -53.996, 15.989}, Arc{-48.0, 15, -53.615, 13.025}, Arc{-33.0, -14, -24.870, 16.854},
        Arc{-20.0, -90, -5.503, 90.32}, Arc{-4.0, -450, 15.50, 449.7}}) {
    const CurvePoint p = at_y(curve, a.y * mm);
    EXPECT_NEAR(-1.0 / p.curvature(), a.radius * mm, 2e-4 * std::abs(a.radius) * mm) << a.y;
    const double length = std::hypot(p.dy, p.dz);
    const double centre_y = p.y + a.radius * mm * p.dz / length;
    const double centre_z = p.z - a.radius * mm * p.dy / length;
    // The fitted centres have two or three decimals; those of R90 and R450 are 0.03 mm uncertain in height.
    EXPECT_NEAR(centre_y, a.centre_y * mm, 0.01 * mm) << a.y;
    EXPECT_NEAR(centre_z, a.centre_z * mm, std::abs(a.radius) > 50 ? 0.04 * mm : 0.01 * mm) << a.y;
  }
  // Cones: z = -(0.02012 + 0.025 y) and 1.2299 - 0.06667 y in mm.
  EXPECT_NEAR(at_y(curve, 15 * mm).z, -(0.02012 + 0.025 * 15) * mm, 0.003 * mm);
  EXPECT_NEAR(tangent_angle(at_y(curve, 15 * mm)), std::atan(0.025), 1e-9);
  EXPECT_NEAR(at_y(curve, 45 * mm).z, (1.2299 - 0.06667 * 45) * mm, 0.003 * mm);
  EXPECT_NEAR(tangent_angle(at_y(curve, 45 * mm)), std::atan(1.0 / 15.0), 1e-9);
  // R14 and R15 meet at 82.4 degrees; the flange is 28 mm high.
  double steepest = 0.0;
  double deepest = 0.0;
  for (double s = curve.s_begin(); s <= curve.s_end(); s += 0.01 * mm) {
    steepest = std::max(steepest, tangent_angle(curve.at(s)));
    deepest = std::max(deepest, curve.at(s).z);
  }
  EXPECT_NEAR(steepest / degree, 82.4, 0.1);
  EXPECT_NEAR(deepest, 28.02 * mm, 0.01 * mm);
}

TEST(WheelConicArcStandIn, HasTheDimensionsThatItIsMadeFor) {
  const ProfileCurve curve = wheel("conic-arc-stand-in");
  EXPECT_NEAR(at_y(curve, 0.0).z, 0.0, 1e-15);
  EXPECT_NEAR(at_y(curve, 40 * mm).z, -1.0 * mm, 1e-12);
  EXPECT_NEAR(curve.at(curve.s_begin()).y, -70 * mm, 1e-12);
  EXPECT_NEAR(tangent_angle(curve.at(curve.s_begin())) / degree, -90.0, 1e-6);
  EXPECT_NEAR(at_y(curve, -37.5 * mm).z, 10 * mm, 1e-9);
  EXPECT_NEAR(tangent_angle(at_y(curve, -37.5 * mm)) / degree, 70.0, 1e-6);
  EXPECT_NEAR(radius_at(curve, -30 * mm), 14 * mm, 0.002 * mm);
  EXPECT_NEAR(radius_at(curve, -50 * mm), -12 * mm, 0.002 * mm);
  double deepest = 0.0;
  for (double s = curve.s_begin(); s <= curve.s_end(); s += 0.01 * mm) deepest = std::max(deepest, curve.at(s).z);
  EXPECT_NEAR(deepest, 30 * mm, 1e-8);
}

TEST(MoreStandardProfiles, MakePairsThatTouchOnTheTread) {
  const auto first_touch = [](const char* w, const char* r, double y) {
    const ContactSearch search(WheelRailPair(wheel(w), ProfileCurve(standard_profile(ProfileKind::rail, r, 1.0 / 40.0)),
                                             PairDimensions{.flange_back = 1.353, .nominal_radius = 0.43}));
    const TouchPoint touch = search.first_touch(y, 0.0, 0.0);
    return search.pair().wheel().at(touch.s_wheel).y;
  };
  for (const auto& [w, r] : {std::pair{"LMA-type", "CHN60"}, std::pair{"conic-arc-stand-in", "JIS60-stand-in"}}) {
    EXPECT_NEAR(first_touch(w, r, 0.0), 0.0, 20 * mm) << w;
    EXPECT_LT(first_touch(w, r, 12 * mm), -35 * mm) << w << " in flange contact";
  }
}

}  // namespace
}  // namespace railtab
