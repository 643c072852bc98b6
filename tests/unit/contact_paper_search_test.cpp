#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact_test_pairs.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/runtime/contact/paper_search.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"

namespace railtab {
namespace {

using contact_test::cone_on_circle;
using contact_test::s1002_on_60e1;

TEST(PaperSearch, SplitsFlangeAndTreadInTheSharpestRoot) {
  const PaperSearch paper(s1002_on_60e1(), 4096);
  // The 13 mm root of S1002 reaches from y = -38.43 mm to -35 mm; it is the sharpest concave arc.
  const CurvePoint split = s1002_on_60e1().wheel().at(paper.split());
  EXPECT_NEAR(1.0 / split.curvature(), 0.013, 1e-5);
  EXPECT_GT(split.y, -0.0385);
  EXPECT_LT(split.y, -0.0349);
}

TEST(PaperSearch, EqualsTheSearchWhereTheWheelIsConvex) {
  const ContactSearch search(s1002_on_60e1());
  const PaperSearch paper(s1002_on_60e1());
  // Flange contact and the left wheel's field side.
  for (WheelsetPose pose : {WheelsetPose{0.008, 0, -0.0086, 0.0192}, WheelsetPose{-0.007, 0, 0.006, 0.0}}) {
    pose.z = search.touch_height(pose.y, pose.roll, pose.yaw) + 1e-4;
    const ContactPatches exact = search.patches(pose);
    const ContactPatches found = paper.patches(pose);
    ASSERT_EQ(exact.count, 1);
    ASSERT_EQ(found.count, 1);
    EXPECT_FALSE(exact.patch[0].concave);
    EXPECT_EQ(found.patch[0].source, PatchSource::online_convex);
    EXPECT_NEAR(found.patch[0].s_wheel, exact.patch[0].s_wheel, 1e-12);
    EXPECT_NEAR(found.patch[0].penetration, exact.patch[0].penetration, 1e-14);
  }
}

// Eqs. 5-10 tend to the common-normal distance as the points close up, from above and within their spacing; with points
// 0.07 mm apart a penetration of 0.02 mm comes out about twice too large.
TEST(PaperSearch, ConcaveSearchTendsToTheCommonNormalDistance) {
  const ContactSearch search(s1002_on_60e1());
  WheelsetPose pose{0.003, 0, 0, 0};
  pose.z = search.touch_height(pose.y, 0, 0) + 2e-5;
  const ContactPatches exact = search.patches(pose);
  ASSERT_EQ(exact.count, 1);
  ASSERT_TRUE(exact.patch[0].concave);
  const double length = s1002_on_60e1().wheel().s_end() - s1002_on_60e1().wheel().s_begin();
  double previous = std::numeric_limits<double>::infinity();
  for (const int points : {500, 1000, 2000, 4000}) {
    const ContactPatches found = PaperSearch(s1002_on_60e1(), points).patches(pose);
    ASSERT_EQ(found.count, 1);
    EXPECT_EQ(found.patch[0].source, PatchSource::online_concave);
    const double error = found.patch[0].penetration - exact.patch[0].penetration;
    EXPECT_GT(error, 0.0);
    EXPECT_LT(error, length / points);
    EXPECT_LT(error, previous);
    previous = error;
  }
  EXPECT_LT(previous, 2e-5);
}

// Between points a wheel that has hardly touched is as deep as half their spacing; to the outline its depth begins at
// zero and follows the lowering.
TEST(PaperSearch, DistanceToTheOutlineHasNoJump) {
  const ContactSearch search(s1002_on_60e1());
  const PaperSearch points(s1002_on_60e1()), outline(s1002_on_60e1(), 1000, PaperDistance::outline);
  const auto depth = [](const PaperSearch& paper, const WheelsetPose& pose) {
    const ContactPatches patches = paper.patches(pose);
    return patches.count > 0 ? patches.patch[0].penetration : 0.0;
  };
  constexpr double step = 1e-7;
  for (const double y : {-2e-3, 0.0, 3e-3, 5.5e-3}) {
    const double touch = search.touch_height(y, 0, 0);
    double previous = 0.0, largest = 0.0;
    for (double lowering = -2e-6; lowering < 40e-6; lowering += step) {
      const double d = depth(outline, {y, touch + lowering, 0, 0});
      largest = std::max(largest, std::abs(d - previous));
      previous = d;
    }
    EXPECT_LT(largest, 2.0 * step) << "y = " << y;
    EXPECT_GT(depth(points, {y, touch + 1e-6, 0, 0}), 25e-6) << "y = " << y;
  }
}

// The outline's lines sag below the wheel by spacing² curvature/8, and the deepest place lies up to half a spacing
// beside a rail point.
TEST(PaperSearch, DistanceToTheOutlineIsOffBySpacingSquared) {
  const ContactSearch search(s1002_on_60e1());
  for (const int points : {500, 1000, 2000, 4000}) {
    const PaperSearch paper(s1002_on_60e1(), points, PaperDistance::outline);
    const double spacing = (s1002_on_60e1().wheel().s_end() - s1002_on_60e1().wheel().s_begin()) / points;
    for (const double y : {-3e-3, 1.5e-3, 3e-3, 4e-3, 6e-3}) {
      WheelsetPose pose{y, 0, 0, 0};
      pose.z = search.touch_height(y, 0, 0) + 2e-5;
      const ContactPatches exact = search.patches(pose);
      const ContactPatches found = paper.patches(pose);
      ASSERT_EQ(exact.count, 1);
      ASSERT_EQ(found.count, 1);
      const double curvature = std::abs(exact.patch[0].curv_wheel) + std::abs(exact.patch[0].curv_rail);
      EXPECT_LT(std::abs(found.patch[0].penetration - exact.patch[0].penetration), curvature * spacing * spacing / 8)
          << points << " points, y = " << y;
    }
  }
}

TEST(PaperSearch, TakesAStraightTreadForConvex) {
  const WheelRailPair pair(ProfileCurve(standard_profile(ProfileKind::wheel, "cone-1:40", 0.0)),
                           ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), {});
  const ContactSearch search(pair);
  const PaperSearch paper(pair);
  for (double y = -5e-3; y < 5e-3; y += 0.1e-3) {
    const WheelsetPose pose{y, search.touch_height(y, 0, 0) + 2e-5, 0, 0};
    const ContactPatches found = paper.patches(pose);
    ASSERT_EQ(found.count, 1);
    EXPECT_EQ(found.patch[0].source, PatchSource::online_convex) << "y = " << y;
  }
}

TEST(PaperSearch, FindsNothingWithoutContact) {
  const PaperSearch paper(s1002_on_60e1());
  EXPECT_EQ(paper.patches({0.0, -0.01, 0.0, 0.0}).count, 0);
  EXPECT_EQ(paper.patches({0.2, 0.01, 0.0, 0.0}).count, 0);
}

TEST(PaperSearch, RejectsPointNumbersOutOfRange) {
  EXPECT_THROW(PaperSearch(s1002_on_60e1(), 9), InputError);
  EXPECT_THROW(PaperSearch(s1002_on_60e1(), PaperSearch::most_points + 1), InputError);
}

}  // namespace
}  // namespace railtab
