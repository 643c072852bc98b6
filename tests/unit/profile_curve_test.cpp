// ProfileCurve: evaluation, interval look-up, set-up queries.

#include "railtab/runtime/profile/profile_curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"

namespace railtab {
namespace {

struct Cubic {
  double a, b, c, d;
  [[nodiscard]] double value(double t) const { return a + t * (b + t * (c + t * d)); }
  [[nodiscard]] double slope(double t) const { return b + t * (2 * c + t * 3 * d); }
  [[nodiscard]] double second(double t) const { return 2 * c + 6 * d * t; }
};
constexpr Cubic y_of_s{0.01, 0.8, 3.0, -20.0};
constexpr Cubic z_of_s{-0.002, -0.3, 7.0, 40.0};

// One cubic cut at the knots given: the curve has to be that cubic everywhere, whichever interval is found.
ProfileKnots cubic_knots(const std::vector<double>& s) {
  ProfileKnots k{ProfileKind::rail, "cubic", s, {}, {}, {}, {}};
  for (const double x : s) {
    k.y.push_back(y_of_s.value(x));
    k.z.push_back(z_of_s.value(x));
    k.dy.push_back(y_of_s.slope(x));
    k.dz.push_back(z_of_s.slope(x));
  }
  return k;
}

std::vector<double> uneven_arc_lengths() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> exponent(-7.0, -3.0);  // spacings from 0.1 µm to 1 mm
  std::vector<double> s{0.0};
  while (s.size() < 300) s.push_back(s.back() + std::pow(10.0, exponent(random)));
  return s;
}

TEST(ProfileCurve, ReproducesCubicWithDerivativesInsideAndBeyondItsEnds) {
  const std::vector<double> s{0.0, 0.011, 0.02, 0.045, 0.05};
  const ProfileCurve curve(cubic_knots(s));
  for (int i = -20; i <= 120; ++i) {
    const double x = 0.0005 * i;  // 10 mm beyond both ends
    const CurvePoint p = curve.at(x);
    EXPECT_NEAR(p.y, y_of_s.value(x), 1e-15);
    EXPECT_NEAR(p.z, z_of_s.value(x), 1e-15);
    EXPECT_NEAR(p.dy, y_of_s.slope(x), 1e-13);
    EXPECT_NEAR(p.dz, z_of_s.slope(x), 1e-13);
    EXPECT_NEAR(p.ddy, y_of_s.second(x), 1e-10);
    EXPECT_NEAR(p.ddz, z_of_s.second(x), 1e-10);
  }
}

// Each interval is a parabola of its own, so that a wrong interval shows in the second derivative.
TEST(ProfileCurve, FindsTheIntervalOfEveryArcLength) {
  ProfileKnots k{ProfileKind::rail, "parabolas", uneven_arc_lengths(), {}, {}, {}, {}};
  double y = 0.0;
  double dy = 0.0;
  for (std::size_t i = 0; i < k.s.size(); ++i) {
    k.y.push_back(y);
    k.dy.push_back(dy);
    k.z.push_back(0.0);
    k.dz.push_back(0.0);
    if (i + 1 == k.s.size()) break;
    const double h = k.s[i + 1] - k.s[i];
    y += dy * h + 0.5 * static_cast<double>(i) * h * h;
    dy += static_cast<double>(i) * h;
  }
  const ProfileCurve curve(k);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> any(0.0, k.s.back());
  for (int n = 0; n < 20000; ++n) {
    const double s = any(random);
    const auto above = std::upper_bound(k.s.begin(), k.s.end() - 1, s);
    const auto interval = static_cast<double>(above - k.s.begin() - 1);
    // Slope differences over 0.1 µm leave some 1e-6 of rounding.
    ASSERT_NEAR(curve.at(s).ddy, interval, 1e-3) << "s = " << s;
  }
  for (std::size_t i = 0; i + 1 < k.s.size(); ++i) ASSERT_EQ(curve.at(k.s[i]).y, k.y[i]) << "knot " << i;
}

TEST(ProfileCurve, EvaluatesAnyNumberWithoutLeavingItsArrays) {
  const ProfileCurve curve(cubic_knots(uneven_arc_lengths()));
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double s : {1e300, -1e300, infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(std::isfinite(curve.at(s).y));
    EXPECT_FALSE(curve.contains(s));
  }
}

TEST(ProfileCurve, CurvatureIsThatOfACircleAndPositiveTowardsPositiveZ) {
  // Quarter circle of radius R through its top, z down: centre below the points, so it bends to +z.
  constexpr double R = 0.3;
  ProfileKnots k{ProfileKind::rail, "circle", {}, {}, {}, {}, {}};
  for (int i = -100; i <= 100; ++i) {
    const double s = i * 1e-4;
    k.s.push_back(s);
    k.y.push_back(R * std::sin(s / R));
    k.z.push_back(R * (1 - std::cos(s / R)));
    k.dy.push_back(std::cos(s / R));
    k.dz.push_back(std::sin(s / R));
  }
  const ProfileCurve curve(k);
  for (double s = -0.01; s <= 0.01; s += 3.3e-5) EXPECT_NEAR(curve.at(s).curvature(), 1 / R, 1e-6 / R);
  const CurvePoint twice{0, 0, 2, 0, 0, 4 / R};  // the same circle run through at double speed
  EXPECT_NEAR(twice.curvature(), 1 / R, 1e-15 / R);
}

TEST(ProfileCurve, FindsArcLengthOfLateralPosition) {
  const ProfileCurve curve(cubic_knots({0.0, 0.011, 0.02, 0.045, 0.05}));
  for (double s = 0.0; s <= 0.05; s += 0.0007) EXPECT_NEAR(curve.s_at_y(curve.at(s).y), s, 1e-14);
  EXPECT_EQ(curve.s_at_y(-1.0), curve.s_begin());
  EXPECT_EQ(curve.s_at_y(1.0), curve.s_end());
}

TEST(ProfileCurve, TakesTheFacingPointOfAnUndercutOutline) {
  // Polyline (0,30) (5,20) (-2,10) (10,0) mm: y = 2 mm is passed three times.
  for (const ProfileKind kind : {ProfileKind::wheel, ProfileKind::rail}) {
    ProfileKnots k{kind,
                   "undercut",
                   {0.0, 0.01, 0.02, 0.03},
                   {0.0, 0.005, -0.002, 0.010},
                   {0.03, 0.02, 0.01, 0.0},
                   {0.6, 0.0, 0.0, 1.0},
                   {-1, -1, -1, -1}};
    const ProfileCurve curve(k);
    const double s = curve.s_at_y(0.002);
    EXPECT_NEAR(curve.at(s).y, 0.002, 1e-15);
    EXPECT_EQ(curve.at(s).z > 0.015, kind == ProfileKind::wheel);
  }
}

TEST(ProfileCurve, FindsHighestPointBetweenKnots) {
  ProfileKnots k{ProfileKind::rail, "parabola", {}, {}, {}, {}, {}};
  for (int i = 0; i <= 10; ++i) {
    const double s = i * 1e-3;
    const double t = s - 4.3e-3;
    k.s.push_back(s);
    k.y.push_back(s);
    k.z.push_back(5 * t * t);
    k.dy.push_back(1);
    k.dz.push_back(10 * t);
  }
  EXPECT_NEAR(ProfileCurve(k).s_at_highest_point(), 4.3e-3, 1e-15);
  for (double& z : k.z) z = -z;
  for (double& dz : k.dz) dz = -dz;
  EXPECT_EQ(ProfileCurve(k).s_at_highest_point(), 0.010);  // highest at an end: 5.7 mm from the summit, not 4.3 mm
}

TEST(ProfileCurve, RejectsBrokenKnots) {
  const ProfileKnots good = cubic_knots({0.0, 0.011, 0.02});
  EXPECT_NO_THROW(ProfileCurve{good});
  ProfileKnots k = good;
  k.s[2] = k.s[1];
  EXPECT_THROW(ProfileCurve{k}, InputError);
  k = good;
  k.z[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(ProfileCurve{k}, InputError);
  k = good;
  k.dy.pop_back();
  EXPECT_THROW(ProfileCurve{k}, InputError);
  EXPECT_THROW(ProfileCurve{cubic_knots({0.0})}, InputError);
}

TEST(ProfileCurve, TangentAngleIsTheArctangent) {
  const ProfileCurve wheel(standard_profile(ProfileKind::wheel, "S1002", 1.0 / 40));
  for (double s = wheel.s_begin(); s <= wheel.s_end(); s += 3.1e-5) {
    const std::size_t piece = wheel.piece_of(s);
    EXPECT_TRUE(wheel.piece_contains(piece, s));
    const CurvePoint p = wheel.on_piece(piece, s);
    EXPECT_EQ(p.y, wheel.at(s).y);
    EXPECT_NEAR(wheel.tangent_angle(piece, p.dy, p.dz, 1 / std::hypot(p.dy, p.dz)), std::atan2(p.dz, p.dy), 1e-15);
  }
}

}  // namespace
}  // namespace railtab
