// spline_through_points: interpolation, order of convergence, end conditions.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/profile_curve.hpp"
#include "railtab/runtime/profile/profile_file.hpp"

namespace railtab {
namespace {

// Quarter of an ellipse with axes 30 and 12 mm, unevenly spaced, n intervals.
struct Points {
  std::vector<double> y, z;
};
Points ellipse(int n) {
  Points p;
  for (int i = 0; i <= n; ++i) {
    const double t = 0.3 + 2.4 * (i + 0.15 * std::sin(6.0 * i / n)) / n;
    p.y.push_back(-0.030 * std::cos(t));
    p.z.push_back(-0.012 * std::sin(t));
  }
  return p;
}

double distance_from_ellipse(const CurvePoint& p) {
  const double f = std::pow(p.y / 0.030, 2) + std::pow(p.z / 0.012, 2) - 1;
  return std::abs(f) / std::hypot(2 * p.y / (0.030 * 0.030), 2 * p.z / (0.012 * 0.012));
}

// Worst distance away from the ends, where the natural end condition costs two orders.
double worst_inside(int n) {
  const Points p = ellipse(n);
  const ProfileCurve curve(spline_through_points(ProfileKind::rail, "ellipse", p.y, p.z));
  double worst = 0.0;
  for (double f = 0.25; f <= 0.75; f += 1e-4)
    worst = std::max(worst, distance_from_ellipse(curve.at(f * curve.s_end())));
  return worst;
}

TEST(SplineThroughPoints, PassesThroughItsPoints) {
  const Points p = ellipse(40);
  const ProfileCurve curve(spline_through_points(ProfileKind::wheel, "ellipse", p.y, p.z));
  ASSERT_EQ(curve.knots().s.size(), p.y.size());
  for (std::size_t i = 0; i < p.y.size(); ++i) {
    EXPECT_NEAR(curve.at(curve.knots().s[i]).y, p.y[i], 1e-17);
    EXPECT_NEAR(curve.at(curve.knots().s[i]).z, p.z[i], 1e-17);
  }
  EXPECT_EQ(curve.knots().kind, ProfileKind::wheel);
  EXPECT_EQ(curve.knots().name, "ellipse");
}

TEST(SplineThroughPoints, ConvergesWithTheFourthOrder) {
  const double order = std::log2(worst_inside(60) / worst_inside(120));
  EXPECT_GT(order, 3.7);
  EXPECT_LT(order, 4.4);
}

TEST(SplineThroughPoints, IsC2AndNaturalAtItsEnds) {
  const Points p = ellipse(30);
  const ProfileCurve curve(spline_through_points(ProfileKind::rail, "ellipse", p.y, p.z));
  const std::vector<double>& s = curve.knots().s;
  const double scale = 1 / 0.0048;  // smallest radius of the ellipse
  EXPECT_NEAR(std::hypot(curve.at(s.front()).ddy, curve.at(s.front()).ddz), 0.0, 1e-9 * scale);
  EXPECT_NEAR(std::hypot(curve.at(s.back()).ddy, curve.at(s.back()).ddz), 0.0, 1e-9 * scale);
  for (std::size_t i = 1; i + 1 < s.size(); ++i) {
    const CurvePoint left = curve.at(s[i] - 1e-15);
    const CurvePoint right = curve.at(s[i]);
    EXPECT_NEAR(left.ddy, right.ddy, 1e-8 * scale);
    EXPECT_NEAR(left.ddz, right.ddz, 1e-8 * scale);
  }
}

TEST(SplineThroughPoints, RunsInArcLength) {
  const Points p = ellipse(60);
  const ProfileCurve curve(spline_through_points(ProfileKind::rail, "ellipse", p.y, p.z));
  for (double f = 0.2; f <= 0.8; f += 1e-3) {
    const CurvePoint q = curve.at(f * curve.s_end());
    EXPECT_NEAR(std::hypot(q.dy, q.dz), 1.0, 1e-4);  // over chord lengths alone the speed is off by h²κ²/24 = 4e-4
  }
}

TEST(SplineThroughPoints, RejectsCoincidentPointsByNumber) {
  try {
    static_cast<void>(spline_through_points(ProfileKind::rail, "doubled", {0, 1e-3, 1e-3, 2e-3}, {0, 0, 0, 0}));
    FAIL() << "point 2 repeats point 1";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("point 2"), std::string::npos) << e.what();
  }
  EXPECT_THROW(static_cast<void>(spline_through_points(ProfileKind::rail, "one", {0}, {0})), InputError);
  EXPECT_THROW(static_cast<void>(spline_through_points(ProfileKind::rail, "uneven", {0, 1}, {0})), InputError);
}

}  // namespace
}  // namespace railtab
