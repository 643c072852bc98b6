// The exact overlap of the outlines, by closed forms; and the contact search against it: an independent count of what
// overlaps.

#include "railtab/tablegen/intersection/outline_overlap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"

namespace railtab {
namespace {

// A cylinder (the wheel, straight along its axle) on a rail head of 1 m radius overlaps it in a circular segment.
TEST(OutlineOverlap, CircularSegmentsHaveTheirKnownWidthAndDepth) {
  std::vector<double> y, z;
  for (int i = -300; i <= 300; ++i) {
    const double a = 1e-4 * i;
    y.push_back(std::sin(a));
    z.push_back(1.0 - std::cos(a));
  }
  const WheelRailPair pair(ProfileCurve(spline_through_points(ProfileKind::wheel, "cylinder",
                                                              {-0.07, -0.02, 0.02, 0.06}, {0.0, 0.0, 0.0, 0.0})),
                           ProfileCurve(spline_through_points(ProfileKind::rail, "arc", y, z)),
                           PairDimensions{.gauge_height = 4e-4});
  const OutlineOverlap overlap(pair);
  for (const double d : {1e-4, 1e-6, 1e-8}) {
    const auto regions = overlap.regions({.z = d});
    ASSERT_EQ(regions.size(), 1U) << d;
    const double chord = std::sqrt(8.0 * OutlineOverlap::chord_error);
    const double width = 2.0 * std::sin(std::acos(1.0 - d));
    EXPECT_NEAR(regions[0].y_high - regions[0].y_low, width, 2.0 * chord) << d;
    EXPECT_NEAR(regions[0].depth, d, 2.0 * OutlineOverlap::chord_error) << d;
    EXPECT_NEAR(regions[0].height, d, 2.0 * OutlineOverlap::chord_error) << d;
  }
  EXPECT_TRUE(overlap.regions({.z = -1e-15}).empty());
  EXPECT_TRUE(overlap.regions({.z = -1e-4}).empty());
}

TEST(OutlineOverlap, EveryRegionHoldsAPatchAndEveryPatchLiesInARegion) {
  const OverlapRegion left{-0.01, -0.005, 1e-4, 1e-4}, right{0.002, 0.004, 2e-4, 5e-5},
      shallow{0.01, 0.011, 1e-8, 5e-9};
  ContactPatches patches;
  const auto patch = [](double y, double penetration) {
    ContactPatch p{};
    p.y_rail = y;
    p.penetration = penetration;
    return p;
  };
  patches.patch[0] = patch(-0.007, 1e-4);
  patches.patch[1] = patch(0.003, 5e-5);
  patches.count = 2;
  EXPECT_FALSE(compare(std::array{left, right}, patches).mismatch);
  const RegionComparison merged = compare(std::array{OverlapRegion{-0.01, 0.004, 1e-4, 1e-4}}, patches);
  EXPECT_FALSE(merged.mismatch || merged.in_band) << "two patches may share a region";
  EXPECT_TRUE(compare(std::array{left}, patches).mismatch);
  EXPECT_TRUE(compare(std::array{left, right, shallow}, patches).in_band);
  EXPECT_FALSE(compare(std::array{left, right, shallow}, patches).mismatch);
  patches.count = 1;
  const RegionComparison missing = compare(std::array{left, right}, patches);
  EXPECT_TRUE(missing.mismatch);
  EXPECT_EQ(missing.height, right.height);
}

TEST(OutlineOverlap, RegionsAndPatchesOfTheSearchBelongTogether) {
  const ContactSearch search(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                           ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), {}));
  const OutlineOverlap overlap(search.pair());
  std::mt19937_64 random(11);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int regions_seen = 0, several = 0, in_band = 0;
  constexpr int poses = 20000;
  for (int i = 0; i < poses; ++i) {
    WheelsetPose pose{uniform(-0.01, 0.01), 0.0, uniform(-0.01, 0.01), uniform(-0.03, 0.03)};
    pose.z = search.touch_height(pose.y, pose.roll, pose.yaw) + std::exp(uniform(std::log(1e-8), std::log(3e-4)));
    const auto regions = overlap.regions(pose);
    const RegionComparison comparison = compare(regions, search.patches(pose));
    regions_seen += static_cast<int>(regions.size());
    several += regions.size() > 1;
    in_band += comparison.in_band;
    EXPECT_FALSE(comparison.mismatch) << "y " << pose.y << " roll " << pose.roll << " yaw " << pose.yaw << " z "
                                      << pose.z << ": " << regions.size() << " regions";
  }
  std::printf("%d regions (%d poses with several), %d in the band\n", regions_seen, several, in_band);
  EXPECT_GT(several, 50);
  EXPECT_LT(in_band, poses / 100);
}

}  // namespace
}  // namespace railtab
