#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "contact_test_pairs.hpp"
#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/runtime/contact/paper_search.hpp"
#include "railtab/tables/input_error.hpp"

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

TEST(PaperSearch, FindsNothingWithoutContact) {
  const PaperSearch paper(s1002_on_60e1());
  EXPECT_EQ(paper.patches({0.0, -0.01, 0.0, 0.0}).count, 0);
  EXPECT_EQ(paper.patches({0.2, 0.01, 0.0, 0.0}).count, 0);
}

TEST(PaperSearch, RefusesPointNumbersOutOfRange) {
  EXPECT_THROW(PaperSearch(s1002_on_60e1(), 9), InputError);
  EXPECT_THROW(PaperSearch(s1002_on_60e1(), PaperSearch::most_points + 1), InputError);
}

}  // namespace
}  // namespace railtab
