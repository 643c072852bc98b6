// The contact search against exact intersection of the outlines: an independent count of what overlaps.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/tablegen/intersection/profile_intersection.hpp"

namespace railtab {
namespace {

TEST(ProfileIntersection, CircularSegmentsHaveTheirKnownAreaAndWidth) {
  // A cylinder (the wheel, straight along its axle) on a rail head of 1 m radius overlaps it in a circular segment.
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
  const double d = 1e-4;
  const auto regions = overlap_regions(pair, {.z = d}, 1e-5);
  ASSERT_EQ(regions.size(), 1u);
  const double half_angle = std::acos(1.0 - d);
  EXPECT_NEAR(regions[0].width(), 2.0 * std::sin(half_angle), 1e-6 * regions[0].width());
  EXPECT_NEAR(regions[0].area, half_angle - std::sin(half_angle) * std::cos(half_angle), 1e-4 * regions[0].area);
  EXPECT_TRUE(overlap_regions(pair, {.z = -d}, 1e-5).empty());
}

TEST(ProfileIntersection, RegionsAndPatchesOfTheSearchBelongTogether) {
  const ContactSearch search(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                           ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), {}));
  constexpr double spacing = 0.05e-3;
  constexpr double chord = 5e-8;  // spacing² times the sharpest curvature of the pair (1/12 mm + 1/13 mm), over 8
  std::mt19937_64 random(11);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int regions_seen = 0, patches_seen = 0, several = 0;
  for (int i = 0; i < 400; ++i) {
    WheelsetPose pose{uniform(-0.01, 0.01), 0.0, uniform(-0.01, 0.01), uniform(-0.03, 0.03)};
    pose.z = search.touch_height(pose.y, pose.roll, pose.yaw) + std::exp(uniform(std::log(1e-6), std::log(3e-4)));
    const auto regions = overlap_regions(search.pair(), pose, spacing);
    const ContactPatches patches = search.patches(pose);
    regions_seen += static_cast<int>(regions.size());
    several += regions.size() > 1;
    for (const OverlapRegion& region : regions) {
      const bool holds_a_patch = std::any_of(patches.begin(), patches.end(), [&](const ContactPatch& p) {
        return p.y_rail > region.y_low - spacing && p.y_rail < region.y_high + spacing;
      });
      EXPECT_TRUE(holds_a_patch) << "y " << pose.y << " roll " << pose.roll << " yaw " << pose.yaw << " z " << pose.z
                                 << ": region " << region.y_low << " .. " << region.y_high;
    }
    for (const ContactPatch& patch : patches) {
      if (patch.penetration < chord) continue;
      ++patches_seen;
      const bool lies_in_a_region = std::any_of(regions.begin(), regions.end(), [&](const OverlapRegion& r) {
        return patch.y_rail > r.y_low - spacing && patch.y_rail < r.y_high + spacing;
      });
      EXPECT_TRUE(lies_in_a_region) << "y " << pose.y << " roll " << pose.roll << " yaw " << pose.yaw << " z " << pose.z
                                    << ": patch at " << patch.y_rail << " of " << patch.penetration;
    }
  }
  std::printf("%d regions (%d poses with several), %d patches\n", regions_seen, several, patches_seen);
  EXPECT_GT(several, 5);
}

}  // namespace
}  // namespace railtab
